// Pictures of the seat: one coarse sample while something moves, then several fine ones, summed.

import { ADD, DEPTH, DISPLAY, MOST_LIGHTS, NOTHING, OVERLAY, SHADE, VERTEX } from "./glsl_surface.js";
import { termsOf } from "./glsl_brdf.js";
import { WHOLE, bind, fill, newTexture, programOf, sampling, set, targetOf, use } from "./gl.js";
import { discPoint, isWide, lightsOf } from "./lights.js";
import { MaterialTable, detailOf, needsOf, reliefsOf, tablesOf } from "./materials.js";
import { Mesh } from "./mesh.js";

/** @typedef {import("./payload.js").Content} Content */
/** @typedef {import("./payload.js").Numbers} Numbers */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {{rig: import("./payload.js").Rig, materials: import("./payload.js").Material[],
 *   look: number[], layer: number, ev100: number, camera: Camera,
 *   photo: {texture: WebGLTexture, pixels: number[], size: number[]} | null}} Shown */

const SHADOW = 2048;
const CARD = 0.18;
const PAPER = Math.pow(97 / 255, 2.2);
// A picture at rest may take so long [ms], one while something moves so long.
const REST = 1100, MOVE = 120;
const SAMPLES = [4, 8, 16];
const SCALES = [1, 1.5, 2, 3, 4];

export class Renderer {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Content} content
   * @param {(name: string) => Numbers} array
   */
  constructor(canvas, content, array) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false, preserveDrawingBuffer: true });
    if (!gl || !gl.getExtension("EXT_color_buffer_float")) throw new Error("no WebGL 2 with float pictures");
    this.canvas = canvas;
    this.gl = gl;
    this.content = content;
    this.mesh = new Mesh(gl, content, array);
    this.table = new MaterialTable(gl, tablesOf(gl, array, content.stretched));
    this.reliefs = reliefsOf(gl, content, array);
    this.programs = {
      overlay: programOf(gl, VERTEX, OVERLAY),
      depth: programOf(gl, DEPTH, NOTHING), display: programOf(gl, WHOLE, DISPLAY), add: programOf(gl, WHOLE, ADD),
    };
    /** @type {Map<string, import("./gl.js").Program>} */
    this.shaders = new Map();
    this.colours = ["viridis", "diverging"].map((name) => this.colourTable(array(name)));
    this.blank = this.colourTable(Uint8Array.of(255, 255, 255));
    this.shadows = this.shadowMaps();
    /** @type {Record<string, ReturnType<typeof targetOf>>} */
    this.targets = {};
    this.shadowKey = "";
    this.cost = 4e-4;  // ms per pixel and sample, measured as it goes; begun with that of software
    this.count = 4;
    this.done = 0;
    gl.enable(gl.DEPTH_TEST);
  }

  /** @param {Numbers} colours */
  colourTable(colours) {
    const gl = this.gl;
    const texture = newTexture(gl);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, colours.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
    sampling(gl, gl.NEAREST, gl.NEAREST, gl.CLAMP_TO_EDGE);
    return texture;
  }

  shadowMaps() {
    const gl = this.gl;
    const layers = Math.max(1, ...this.content.rigs.map((rig) => Math.min(rig.lights.length, MOST_LIGHTS)));
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.DEPTH_COMPONENT24, SHADOW, SHADOW, layers);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE], [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL]]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, key, value);
    }
    const frames = Array.from({ length: layers }, (_, k) => {
      const frame = gl.createFramebuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, texture, 0, k);
      gl.drawBuffers([gl.NONE]);
      gl.readBuffer(gl.NONE);
      return frame;
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return { texture, frames };
  }

  /** @param {string} name @param {number} width @param {number} height @param {boolean} depth */
  target(name, width, height, depth) {
    const old = this.targets[name];
    if (old && old.width === width && old.height === height) return old;
    old?.drop();
    this.targets[name] = targetOf(this.gl, width, height, this.gl.RGBA16F, depth);
    return this.targets[name];
  }

  /** Begin a picture anew. */
  restart() {
    this.done = 0;
  }

  /**
   * Draw another seat of the page from now on.
   * @param {Content} content
   * @param {Mesh} mesh
   */
  put(content, mesh) {
    this.content = content;
    this.mesh = mesh;
    this.shadowKey = "";
  }

  /** Materials have changed. @param {Shown} shown */
  refill(shown) {
    this.table.fill(shown.materials);
  }

  /**
   * One sample while something moves, as coarse as it must be.
   * @param {Shown} shown
   */
  move(shown) {
    const { width, height } = this.canvas;
    const scale = SCALES.find((s) => this.cost * width * height / (s * s) <= MOVE) ?? SCALES[SCALES.length - 1];
    const size = [Math.max(1, Math.round(width / scale)), Math.max(1, Math.round(height / scale))];
    const start = performance.now();
    this.sample(shown, size, 0, 1, scale === 1 ? "one" : "coarse");
    this.display(this.targets[scale === 1 ? "one" : "coarse"].texture, 1, shown);
    this.wait();
    this.learn(performance.now() - start, size);
    this.restart();
    return size;
  }

  /**
   * The next sample of a picture at rest; false once all are there.
   * @param {Shown} shown
   * @param {number} most samples, where their number does not go by time
   */
  rest(shown, most = 0) {
    const { gl } = this;
    const { width, height } = this.canvas;
    if (this.done === 0) {
      const within = SAMPLES.filter((n) => n * this.cost * width * height <= REST);
      this.count = most || (within[within.length - 1] ?? SAMPLES[0]);
    }
    if (this.done >= this.count) return false;
    const start = performance.now();
    this.sample(shown, [width, height], this.done, this.count, "one");
    const sum = this.target("sum", width, height, false);
    gl.bindFramebuffer(gl.FRAMEBUFFER, sum.frame);
    gl.viewport(0, 0, width, height);
    if (this.done === 0) gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    use(gl, this.programs.add, {});
    bind(gl, this.programs.add, { uNew: this.targets.one.texture });
    fill(gl);
    gl.disable(gl.BLEND);
    this.done += 1;
    this.display(sum.texture, this.done, shown);
    this.wait();
    this.learn(performance.now() - start, [width, height]);
    return this.done < this.count;
  }

  /** Wait until all is drawn: one pixel is read. */
  wait() {
    this.gl.readPixels(0, 0, 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  /** @param {number} time [ms] @param {number[]} size */
  learn(time, size) {
    this.cost += 0.5 * (time / (size[0] * size[1]) - this.cost);
  }

  /**
   * Draw one sample of all pixels into a target.
   * @param {Shown} shown
   * @param {number[]} size
   * @param {number} index of the sample
   * @param {number} count of all samples
   * @param {string} into
   */
  sample(shown, size, index, count, into) {
    const { gl, mesh } = this;
    const spot = count > 1 ? discPoint(index) : [0, 0];
    const { uniforms, shadow } = lightsOf(shown.rig, mesh, spot, SHADOW);
    if (shown.layer < 0) this.drawShadows(shown, shadow, index, count);
    const target = this.target(into, size[0], size[1], true);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.viewport(0, 0, size[0], size[1]);
    const white = 1 / (1.2 * Math.pow(2, shown.ev100));
    const card = CARD * 2.5 / 1.2 / Math.PI;
    const paper = shown.layer < 0 ? shown.rig.white.map((c) => c * card) : [PAPER, PAPER, PAPER];
    gl.clearBufferfv(gl.COLOR, 0, [...paper, 1]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    const shift = jitter(index, count).map((s, i) => 2 * s / size[i]);
    const view = {
      uCamera: shown.camera.matrix(size[0] / size[1], mesh.reach, mesh.middle, shift),
      uEye: shown.camera.position, ...mesh.ranges,
    };
    // The wrong side of the cover shows from below or through a gap: it can wait until all is still.
    if (count === 1 && shown.camera.state.elevation > 0) gl.enable(gl.CULL_FACE);
    if (shown.layer >= 0) this.drawMap(shown, view);
    else this.drawParts(shown, { ...view, ...uniforms }, size, count, white);
    gl.disable(gl.CULL_FACE);
  }

  /** @param {Shown} shown @param {Float32Array} matrices @param {number} index @param {number} count */
  drawShadows(shown, matrices, index, count) {
    const { gl, mesh } = this;
    const wide = count > 1 && shown.rig.lights.some((light) => isWide(light, mesh.middle));
    const key = JSON.stringify([shown.rig.lights.map((l) => [l.vector, l.sides]), wide ? [index, count] : 0]);
    if (key === this.shadowKey) return;
    this.shadowKey = key;
    gl.viewport(0, 0, SHADOW, SHADOW);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    use(gl, this.programs.depth, mesh.ranges);
    for (let k = 0; k < shown.rig.lights.length; ++k) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadows.frames[k]);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      set(gl, this.programs.depth, { uCamera: matrices.subarray(16 * k, 16 * k + 16) });
      this.drawCover();
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** All but the foam, which is not in the way of light. */
  drawCover() {
    const foam = this.content.parts[this.content.parts.length - 1];
    this.mesh.draw(0, foam.first);
  }

  /**
   * @param {Shown} shown
   * @param {Record<string, import("./gl.js").Value>} view
   * @param {number[]} size
   * @param {number} count
   * @param {number} white
   */
  drawParts(shown, view, size, count, white) {
    const { gl, mesh, content } = this;
    const { thread } = content;
    const pixel = 2 * shown.camera.half(size[0] / size[1]) / size[1];
    const common = {
      ...view, uWhite: white, uSpread: 1 / Math.sqrt(count), uPixel: pixel / Math.sqrt(count),
      uSky: shown.rig.sky, uThread: [thread.offset, thread.pitch, thread.length, thread.width],
      uThreadColour: [...thread.colour, thread.own],
    };
    const prepared = new Set();
    content.parts.forEach((part, k) => {
      const row = shown.look[k], last = k === content.parts.length - 1;
      const detail = detailOf(shown.materials[row], content, this.reliefs);
      const photo = last ? null : shown.photo;
      const shade = this.shader(needsOf(shown.materials[row], photo !== null));
      use(gl, shade, prepared.has(shade) ? {} : common);
      prepared.add(shade);
      set(gl, shade, {
        ...detail.uniforms, uRow: row, uPhotoSize: photo ? [...photo.size, ...photo.pixels] : [0, 0, 0, 0],
      });
      const slopes = detail.texture ?? this.blank;
      bind(gl, shade, {
        ...this.table.textures, uShadows: this.shadows.texture, uSlopes: slopes, uPhoto: photo?.texture ?? this.blank,
      });
      mesh.draw(part.first, part.count);
    });
  }

  /**
   * The shader with these terms and no more.
   * @param {Record<string, boolean>} needs
   */
  shader(needs) {
    const key = termsOf(needs);
    const found = this.shaders.get(key) ?? programOf(this.gl, VERTEX, key + SHADE);
    this.shaders.set(key, found);
    return found;
  }

  /** @param {Shown} shown @param {Record<string, import("./gl.js").Value>} view */
  drawMap(shown, view) {
    const { gl, mesh, content } = this;
    const { overlay } = this.programs;
    mesh.lay(shown.layer);
    use(gl, overlay, view);
    bind(gl, overlay, { uColours: this.colours[content.maps[shown.layer].low < 0 ? 1 : 0] });
    content.parts.forEach((part, k) => {
      set(gl, overlay, { uCover: k < content.parts.length - 1 });
      mesh.draw(part.first, part.refined || part.count);
    });
    mesh.lay(-1);
  }

  /** @param {WebGLTexture} texture @param {number} count @param {Shown} shown */
  display(texture, count, shown) {
    const { gl } = this;
    const { width, height } = this.canvas;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    use(gl, this.programs.display, {
      uCount: count, uNeutral: shown.layer < 0 ? shown.rig.white : [1, 1, 1], uSize: [width, height],
    });
    bind(gl, this.programs.display, { uSum: texture });
    fill(gl);
  }
}

/**
 * Place of a sample in its pixel, from -1/2 to 1/2; Roberts 2018.
 * @param {number} index
 * @param {number} count
 */
function jitter(index, count) {
  if (count === 1) return [0, 0];
  const at = [(0.25 + 0.7548776662466927 * (index + 7)) % 1, (0.75 + 0.5698402909980532 * (index + 7)) % 1];
  return at.map((value) => value - 0.5);
}
