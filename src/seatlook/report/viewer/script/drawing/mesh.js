// Triangles of the seat, on the card and for rays.

import { along, cross, dot, minus } from "./matrix.js";

/** @typedef {import("./payload.js").Content} Content */
/** @typedef {import("./payload.js").Numbers} Numbers */
/** @typedef {{part: number, triangle: number, weights: number[], place: number[]}} Hit */

/**
 * Directions of the warp at the vertices, as 8-bit numbers: dx/du of the faces around, by their areas.
 * @param {Float32Array} x
 * @param {Numbers} uv
 * @param {Numbers} faces
 */
function warpOf(x, uv, faces) {
  const sum = new Float32Array(x.length);
  for (let k = 0; k < faces.length; k += 3) {
    const [a, b, c] = [faces[k], faces[k + 1], faces[k + 2]];
    const r = uv[2 * c + 1] - uv[2 * a + 1], q = uv[2 * b + 1] - uv[2 * a + 1];
    for (let i = 0; i < 3; ++i) {
      const along_u = (x[3 * b + i] - x[3 * a + i]) * r - (x[3 * c + i] - x[3 * a + i]) * q;
      sum[3 * a + i] += along_u;
      sum[3 * b + i] += along_u;
      sum[3 * c + i] += along_u;
    }
  }
  const out = new Int8Array(x.length);
  for (let k = 0; k < x.length; k += 3) {
    const length = Math.hypot(sum[k], sum[k + 1], sum[k + 2]) || 1;
    for (let i = 0; i < 3; ++i) out[k + i] = Math.round(127 * sum[k + i] / length);
  }
  return out;
}

export class Mesh {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Content} content
   * @param {(name: string) => Numbers} array
   */
  constructor(gl, content, array) {
    this.gl = gl;
    this.content = content;
    this.faces = array("faces");
    this.pattern = array("pattern");
    const steps = array("position");
    const { low, step } = content.position;
    this.x = new Float32Array(steps.length);
    for (let k = 0; k < steps.length; ++k) this.x[k] = low[k % 3] + step[k % 3] * steps[k];
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.attribute(0, steps, 3, false);
    this.attribute(1, array("normal"), 2, true);
    this.attribute(2, this.pattern, 2, false);
    this.attribute(3, array("seam"), 3, false);
    this.attribute(4, warpOf(this.x, this.pattern, this.faces), 3, true);
    this.open = this.attribute(5, array("open"), 1, true);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.faces, gl.STATIC_DRAW);
    this.indexType = this.faces instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
    gl.bindVertexArray(null);
    this.layers = content.maps.map((map) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, array(`map ${map.name}`), gl.STATIC_DRAW);
      return buffer;
    });
    const { middle, reach } = this.measure();
    this.middle = middle;
    this.reach = reach;
  }

  /** Middle and reach of the seat. */
  measure() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let k = 0; k < this.x.length; ++k) {
      low[k % 3] = Math.min(low[k % 3], this.x[k]);
      high[k % 3] = Math.max(high[k % 3], this.x[k]);
    }
    const middle = low.map((value, i) => (value + high[i]) / 2);
    let reach = 0;
    for (let k = 0; k < this.x.length; k += 3) {
      const d = minus([this.x[k], this.x[k + 1], this.x[k + 2]], middle);
      reach = Math.max(reach, dot(d, d));
    }
    return { middle, reach: 1.02 * Math.sqrt(reach) };
  }

  /**
   * @param {number} place
   * @param {Numbers} values
   * @param {number} columns
   * @param {boolean} share whether whole numbers stand for -1 or 0 to 1
   * @returns {WebGLBuffer}
   */
  attribute(place, values, columns, share) {
    const gl = this.gl;
    const type = { Int8Array: gl.BYTE, Uint8Array: gl.UNSIGNED_BYTE, Int16Array: gl.SHORT,
      Uint16Array: gl.UNSIGNED_SHORT }[values.constructor.name];
    const buffer = /** @type {WebGLBuffer} */ (gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, columns, type ?? gl.FLOAT, share, 0, 0);
    return buffer;
  }

  /**
   * Let shaders read a map in the place of the open share, or that again.
   * @param {number} layer its number, below 0 for none
   */
  lay(layer) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, layer < 0 ? this.open : this.layers[layer]);
    gl.vertexAttribPointer(5, 1, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.bindVertexArray(null);
  }

  /** @param {number} first @param {number} count of triangles */
  draw(first, count) {
    const gl = this.gl;
    gl.bindVertexArray(this.array);
    gl.drawElements(gl.TRIANGLES, 3 * count, this.indexType, 3 * first * this.faces.BYTES_PER_ELEMENT);
  }

  drawAll() {
    this.draw(0, this.faces.length / 3);
  }

  /** Uniforms by which shaders read the vertices. */
  get ranges() {
    const { position, pattern, seam } = this.content;
    return {
      uLow: position.low, uStep: position.step,
      uPatternRange: [...pattern.low, ...pattern.step], uSeamRange: [seam.reach, seam.arc],
    };
  }

  /**
   * The first triangle that a ray meets.
   * @param {number[]} origin
   * @param {number[]} ray
   * @returns {Hit | null}
   */
  hit(origin, ray) {
    let nearest = Infinity, found = -1, weights = [0, 0, 0];
    const { x, faces } = this;
    for (let k = 0; k < faces.length; k += 3) {
      const a = 3 * faces[k], b = 3 * faces[k + 1], c = 3 * faces[k + 2];
      const e1x = x[b] - x[a], e1y = x[b + 1] - x[a + 1], e1z = x[b + 2] - x[a + 2];
      const e2x = x[c] - x[a], e2y = x[c + 1] - x[a + 1], e2z = x[c + 2] - x[a + 2];
      const px = ray[1] * e2z - ray[2] * e2y, py = ray[2] * e2x - ray[0] * e2z, pz = ray[0] * e2y - ray[1] * e2x;
      const det = e1x * px + e1y * py + e1z * pz;
      if (Math.abs(det) < 1e-14) continue;
      const sx = origin[0] - x[a], sy = origin[1] - x[a + 1], sz = origin[2] - x[a + 2];
      const u = (sx * px + sy * py + sz * pz) / det;
      if (u < 0 || u > 1) continue;
      const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
      const v = (ray[0] * qx + ray[1] * qy + ray[2] * qz) / det;
      if (v < 0 || u + v > 1) continue;
      const t = (e2x * qx + e2y * qy + e2z * qz) / det;
      if (t > 1e-6 && t < nearest) [nearest, found, weights] = [t, k / 3, [1 - u - v, u, v]];
    }
    if (found < 0) return null;
    const part = this.content.parts.findIndex(({ first, count }) => found >= first && found < first + count);
    return { part, triangle: found, weights, place: along(origin, nearest, ray) };
  }

  /**
   * Unit normal of a triangle.
   * @param {number} triangle
   */
  normal(triangle) {
    const [a, b, c] = [0, 1, 2].map((k) => {
      const v = 3 * this.faces[3 * triangle + k];
      return [this.x[v], this.x[v + 1], this.x[v + 2]];
    });
    const n = cross(minus(b, a), minus(c, a));
    return n.map((value) => value / Math.max(Math.hypot(...n), 1e-20));
  }

  /**
   * Pattern coordinates [m] in a triangle.
   * @param {Hit} hit
   */
  patternAt(hit) {
    const { low, step } = this.content.pattern;
    return [0, 1].map((i) => hit.weights.reduce((sum, weight, k) => {
      const vertex = this.faces[3 * hit.triangle + k];
      return sum + weight * (low[i] + step[i] * this.pattern[2 * vertex + i]);
    }, 0));
  }

  /**
   * Number of the solver's face, in the order in which maps lie; -1 beside the cover.
   * @param {Hit} hit
   */
  solverFace(hit) {
    const { parts, children } = this.content;
    const inside = hit.triangle - parts[hit.part].first;
    if (inside >= parts[hit.part].refined) return -1;
    const before = parts.slice(0, hit.part).reduce((sum, part) => sum + part.refined, 0);
    return Math.floor((before + inside) / children);
  }
}
