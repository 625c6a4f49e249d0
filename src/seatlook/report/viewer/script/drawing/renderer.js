// Pictures of the seat: one coarse sample while something moves, then several fine ones, summed.

import { DISPLAY, OVERLAY, SHADE } from "./glsl_surface.js";
import { termsOf } from "./glsl_brdf.js";
import { WHOLE, bind, fill, newTexture, programOf, sampling, set, use } from "./gl.js";
import { discPoint, isWide, lightsOf } from "./lights.js";
import { MaterialTable, detailOf, needsOf, reliefsOf, tablesOf } from "./materials.js";
import { Mesh } from "./mesh.js";
import { Pane, SHADOW } from "./pane.js";
import { Seen } from "./seen.js";
import { TILES, Tiles } from "./tiles.js";

/** @typedef {import("./payload.js").Content} Content */
/** @typedef {import("./payload.js").Numbers} Numbers */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {{rig: import("./payload.js").Rig, materials: import("./payload.js").Material[],
 *   look: number[], layer: number, ev100: number, camera: Camera,
 *   photo: {texture: WebGLTexture, pixels: number[], size: number[]} | null}} Shown */

const CARD = 0.18;
const PAPER = Math.pow(97 / 255, 2.2);
// A picture at rest may take so long [ms], one while something moves so long.
const REST = 1100, MOVE = 120;
const SAMPLES = [4, 8, 16, 32, 64];
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
    const table = new MaterialTable(gl, tablesOf(gl, array, content.stretched));
    this.pane = new Pane(gl, content, new Mesh(gl, content, array), table);
    this.reliefs = reliefsOf(gl, content, array);
    this.programs = {
      overlay: programOf(gl, WHOLE, OVERLAY), display: programOf(gl, WHOLE, DISPLAY),
    };
    /** @type {Map<string, import("./gl.js").Program>} */
    this.shaders = new Map();
    this.colours = ["viridis", "diverging"].map((name) => this.colourTable(array(name)));
    this.blank = this.colourTable(Uint8Array.of(255, 255, 255));
    this.seen = new Seen(gl);
    this.tiles = new Tiles(gl);
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

  get content() {
    return this.pane.content;
  }

  get mesh() {
    return this.pane.mesh;
  }

  /** Left, lower end, width and height of what is drawn into. */
  get area() {
    return this.pane.area ?? [0, 0, this.canvas.width, this.canvas.height];
  }

  /** Begin a picture anew. */
  restart() {
    this.done = 0;
  }

  /** Materials have changed. @param {Shown} shown */
  refill(shown) {
    this.pane.table.fill(shown.materials);
  }

  /**
   * One sample while something moves, as coarse as it must be.
   * @param {Shown} shown
   */
  move(shown) {
    const { width: wide, height: high } = this.canvas, [, , width, height] = this.area;
    // All of the canvas is drawn in that time, in however many parts.
    const scale = SCALES.find((s) => this.cost * wide * high / (s * s) <= MOVE) ?? SCALES[SCALES.length - 1];
    const size = [Math.max(1, Math.round(width / scale)), Math.max(1, Math.round(height / scale))];
    const start = performance.now();
    this.seen.fit(width, height);
    this.seen.clear();
    this.sample(shown, size, 0, 1);
    this.display(size, 1, shown);
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
    const { width: wide, height: high } = this.canvas, [, , width, height] = this.area;
    if (this.done === 0) {
      const within = SAMPLES.filter((n) => n * this.cost * wide * high <= REST);
      this.count = most || (within[within.length - 1] ?? SAMPLES[0]);
    }
    if (this.done >= this.count) return false;
    const start = performance.now(), size = [width, height];
    this.seen.fit(width, height);
    if (this.done === 0) this.seen.clear();
    this.sample(shown, size, this.done, this.count);
    this.done += 1;
    this.display(size, this.done, shown);
    this.wait();
    this.learn(performance.now() - start, size);
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
   * Add one sample of all pixels to the sum.
   * @param {Shown} shown
   * @param {number[]} size
   * @param {number} index of the sample
   * @param {number} count of all samples
   */
  sample(shown, size, index, count) {
    const { gl, mesh, seen } = this;
    const { uniforms, shadow } = lightsOf(shown.rig, mesh, count > 1 ? discPoint(index) : [0, 0], SHADOW);
    if (shown.layer < 0) this.drawShadows(shown, shadow, index, count);
    const shift = jitter(index, count).map((s, i) => 2 * s / size[i]);
    const view = {
      ...shown.camera.uniforms(size[0] / size[1], mesh.reach, mesh.middle, shift), ...mesh.ranges, uDrawn: size,
    };
    // The wrong side of the cover shows from below or through a gap: it can wait until all is still.
    if (count === 1 && shown.camera.state.elevation > 0) gl.enable(gl.CULL_FACE);
    seen.look(size, view, () => this.drawSeat(shown));
    gl.disable(gl.CULL_FACE);
    // Of further samples, pixels are shifted by less than tiles reach over.
    if (shown.layer < 0 && index === 0) this.tiles.read(seen.what, size, shown.materials.length);
    seen.add(size, () => {
      if (shown.layer >= 0) this.drawMap(shown, view);
      else this.drawLooks(shown, { ...view, ...uniforms }, count);
    });
  }

  /** @param {Shown} shown */
  drawSeat(shown) {
    const { gl, mesh, content, seen } = this;
    if (shown.layer >= 0) mesh.lay(shown.layer);
    content.parts.forEach((part, k) => {
      set(gl, seen.see, { uRow: shown.look[k] });
      mesh.draw(part.first, shown.layer < 0 ? part.count : part.refined || part.count);
    });
    if (shown.layer >= 0) mesh.lay(-1);
  }

  /** @param {Shown} shown @param {Float32Array} matrices @param {number} index @param {number} count */
  drawShadows(shown, matrices, index, count) {
    const { gl, mesh } = this;
    const wide = count > 1 && shown.rig.lights.some((light) => isWide(light, mesh.middle));
    const key = JSON.stringify([shown.rig.lights.map((l) => [l.vector, l.sides]), wide ? [index, count] : 0]);
    if (key === this.pane.shadowKey) return;
    this.pane.shadowKey = key;
    gl.viewport(0, 0, SHADOW, SHADOW);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    use(gl, this.seen.depth, mesh.ranges);
    for (let k = 0; k < shown.rig.lights.length; ++k) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.pane.shadows.frames[k]);
      gl.clearBufferfv(gl.DEPTH, 0, [1]);
      set(gl, this.seen.depth, { uCamera: matrices.subarray(16 * k, 16 * k + 16) });
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
   * Shade the pixels of each material.
   * @param {Shown} shown
   * @param {Record<string, import("./gl.js").Value>} view
   * @param {number} count
   */
  drawLooks(shown, view, count) {
    const { gl, content } = this;
    const { thread } = content;
    const size = /** @type {number[]} */ (view.uDrawn);
    const pixel = 2 * shown.camera.half(size[0] / size[1]) / size[1];
    const common = {
      ...view, uWhite: 1 / (1.2 * Math.pow(2, shown.ev100)), uSpread: 1 / Math.sqrt(count), uPixel: pixel / Math.sqrt(count),
      uSky: shown.rig.sky, uThread: [thread.offset, thread.pitch, thread.length, thread.width],
      uThreadColour: [...thread.colour, thread.own], uGauge: thread.gauge,
    };
    const prepared = new Set(), foam = shown.look[content.parts.length - 1];
    shown.materials.forEach((material, row) => {
      const detail = detailOf(material, content, this.reliefs);
      const photo = row === foam ? null : shown.photo;
      for (const sewn of [false, true]) {
        if (!this.tiles.has(row, sewn)) continue;
        const shade = this.shader({ ...needsOf(material, photo !== null), sewn });
        use(gl, shade, prepared.has(shade) ? {} : common);
        prepared.add(shade);
        set(gl, shade, {
          ...detail.uniforms, uRow: row, uPhotoSize: photo ? [...photo.size, ...photo.pixels] : [0, 0, 0, 0],
        });
        bind(gl, shade, {
          ...this.pane.table.textures, uShadows: this.pane.shadows.texture, uSlopes: detail.texture ?? this.blank,
          uPhoto: photo?.texture ?? this.blank, ...this.seen.what,
        });
        this.tiles.draw(row, sewn);
      }
    });
  }

  /**
   * The shader with these terms and no more.
   * @param {Record<string, boolean>} needs
   */
  shader(needs) {
    const key = termsOf(needs);
    const found = this.shaders.get(key) ?? programOf(this.gl, TILES, key + SHADE);
    this.shaders.set(key, found);
    return found;
  }

  /** @param {Shown} shown @param {Record<string, import("./gl.js").Value>} view */
  drawMap(shown, view) {
    const { gl, content } = this;
    const { overlay } = this.programs;
    use(gl, overlay, { ...view, uFoam: shown.look[content.parts.length - 1] });
    bind(gl, overlay, { uColours: this.colours[content.maps[shown.layer].low < 0 ? 1 : 0], ...this.seen.what });
    fill(gl);
  }

  /** Radiance over white beside the seat. @param {Shown} shown */
  paper(shown) {
    if (shown.layer >= 0) return [PAPER, PAPER, PAPER];
    const card = CARD * 2.5 / 1.2 / Math.PI;
    return shown.rig.white.map((c) => c * card);
  }

  /** @param {number[]} size as much of the sum as is drawn @param {number} count @param {Shown} shown */
  display(size, count, shown) {
    const { gl } = this;
    const [left, low, width, height] = this.area;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(left, low, width, height);
    use(gl, this.programs.display, {
      uCount: count, uNeutral: shown.layer < 0 ? shown.rig.white : [1, 1, 1], uArea: [left, low, width, height], uDrawn: size,
      uPaper: this.paper(shown),
    });
    bind(gl, this.programs.display, { uSum: this.seen.shaded });
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
