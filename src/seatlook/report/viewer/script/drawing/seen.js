// The pictures between triangles and display: what each pixel sees, and the sum of what it is shaded.

import { DEPTH, NOTHING, SEE, VERTEX } from "./glsl_seen.js";
import { newTexture, programOf, sampling, use } from "./gl.js";

/** @typedef {import("./gl.js").Value} Value */

export class Seen {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.see = programOf(gl, VERTEX, SEE);
    this.depth = programOf(gl, DEPTH, NOTHING);
    this.width = 0;
    this.height = 0;
    /** @type {WebGLTexture[]} */
    this.textures = [];
    this.frame = gl.createFramebuffer();
    this.sum = gl.createFramebuffer();
    /** @type {WebGLRenderbuffer | null} */
    this.buffer = null;
  }

  /** Have room for pictures so large. @param {number} width @param {number} height */
  fit(width, height) {
    if (this.width === width && this.height === height) return;
    const { gl } = this;
    [this.width, this.height] = [width, height];
    for (const texture of this.textures) gl.deleteTexture(texture);
    gl.deleteRenderbuffer(this.buffer);
    this.textures = [gl.RGBA32UI, gl.RGBA32UI, gl.RGBA16F].map((inside) => {
      const texture = newTexture(gl);
      gl.texStorage2D(gl.TEXTURE_2D, 1, inside, width, height);
      sampling(gl, gl.NEAREST, gl.NEAREST, gl.CLAMP_TO_EDGE);
      return texture;
    });
    this.buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    this.attach(this.frame, this.textures.slice(0, 2));
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, this.buffer);
    this.attach(this.sum, this.textures.slice(2));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** @param {WebGLFramebuffer | null} frame @param {WebGLTexture[]} textures */
  attach(frame, textures) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const places = textures.map((_, k) => gl.COLOR_ATTACHMENT0 + k);
    textures.forEach((texture, k) => gl.framebufferTexture2D(gl.FRAMEBUFFER, places[k], gl.TEXTURE_2D, texture, 0));
    gl.drawBuffers(places);
  }

  /** What pixels see, by the names that shaders read it. */
  get what() {
    return { uPlace: this.textures[0], uSides: this.textures[1] };
  }

  get shaded() {
    return this.textures[2];
  }

  /** Forget what was shaded. */
  clear() {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sum);
    gl.clearBufferfv(gl.COLOR, 0, [0, 0, 0, 0]);
  }

  /**
   * Write what each pixel sees.
   * @param {number[]} size as much of the pictures as is drawn
   * @param {Record<string, Value>} view
   * @param {() => void} draw
   */
  look(size, view, draw) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.viewport(0, 0, size[0], size[1]);
    gl.clearBufferuiv(gl.COLOR, 1, [0, 0, 0, 0]);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    use(gl, this.see, view);
    draw();
  }

  /**
   * Shade pixels and add that to the sum.
   * @param {number[]} size
   * @param {() => void} shade
   */
  add(size, shade) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.sum);
    gl.viewport(0, 0, size[0], size[1]);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    shade();
    gl.disable(gl.BLEND);
  }
}
