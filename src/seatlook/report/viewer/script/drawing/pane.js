// A seat in its part of the picture: its triangles, its materials, and the shadows that fall on it.

import { MOST_LIGHTS } from "./glsl_surface.js";
import { MaterialTable } from "./materials.js";

/** @typedef {import("./payload.js").Content} Content */
/** @typedef {import("./mesh.js").Mesh} Mesh */

/** Texels across a shadow map. */
export const SHADOW = 2048;

export class Pane {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Content} content
   * @param {Mesh} mesh
   * @param {MaterialTable} table
   */
  constructor(gl, content, mesh, table) {
    this.gl = gl;
    this.content = content;
    this.mesh = mesh;
    this.table = table;
    this.shadows = shadowMaps(gl, content);
    this.shadowKey = "";
    /** @type {number[] | null} left, lower end, width, height [pixels]; the whole picture without */
    this.area = null;
  }

  /**
   * Show another seat here.
   * @param {Content} content
   * @param {Mesh} mesh
   */
  put(content, mesh) {
    this.content = content;
    this.mesh = mesh;
    this.shadowKey = "";
  }

  /** Room for one more seat of the page. @param {Content} content @param {Mesh} mesh */
  another(content, mesh) {
    return new Pane(this.gl, content, mesh, new MaterialTable(this.gl, this.table.tables, this.table.program));
  }
}

/** A map for each light of a rig. @param {WebGL2RenderingContext} gl @param {Content} content */
function shadowMaps(gl, content) {
  const layers = Math.max(1, ...content.rigs.map((rig) => Math.min(rig.lights.length, MOST_LIGHTS)));
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
