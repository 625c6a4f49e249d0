// Which pieces of the picture see which material: only those are shaded. Software shades all that a
// triangle covers, also what a test of depth would throw away.

import { SEEN } from "./glsl_seen.js";
import { WHOLE, bind, fill, programOf, targetOf, use } from "./gl.js";

const TILE = 16;

// Bits of the rows seen in a tile or beside it, and of those with a seam near.
const ROWS = `${SEEN}
out uvec4 oRows;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * ${TILE} - 1, last = ivec2(uDrawn) - 1;
  uint rows = 0u, sewn = 0u;
  for (int y = 0; y < ${TILE + 2}; ++y) {
    for (int x = 0; x < ${TILE + 2}; ++x) {
      ivec2 at = clamp(first + ivec2(x, y), ivec2(0), last);
      uint row = texelFetch(uSides, at, 0).x & 255u;
      uint bit = row == 0u ? 0u : 1u << (row - 1u & 31u);
      rows |= bit;
      sewn |= texelFetch(uPlace, at, 0).w % 65536u == 65535u ? 0u : bit;
    }
  }
  oRows = uvec4(rows, sewn, 0u, 1u);
}
`;

// Rectangles in pixels.
export const TILES = `
layout(location = 0) in vec2 inCorner;
uniform vec2 uDrawn;
void main() { gl_Position = vec4(2.0 * inCorner / uDrawn - 1.0, 0.0, 1.0); }
`;

export class Tiles {
  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.gl = gl;
    this.program = programOf(gl, WHOLE, ROWS);
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer = gl.createBuffer());
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.UNSIGNED_SHORT, false, 0, 0);
    gl.bindVertexArray(null);
    /** @type {ReturnType<typeof targetOf> | null} */
    this.target = null;
    /** @type {Map<string, number[]>} first vertex and their number, by row and whether a seam is near */
    this.places = new Map();
  }

  /**
   * Read what the tiles of a picture see.
   * @param {Record<string, WebGLTexture>} textures of what is seen
   * @param {number[]} size
   * @param {number} rows of materials
   */
  read(textures, size, rows) {
    const { gl } = this;
    const [width, height] = size.map((s) => Math.ceil(s / TILE));
    if (this.target?.width !== width || this.target.height !== height) {
      this.target?.drop();
      this.target = targetOf(gl, width, height, gl.RGBA32UI, false);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.target.frame);
    gl.viewport(0, 0, width, height);
    use(gl, this.program, { uDrawn: size });
    bind(gl, this.program, textures);
    fill(gl);
    const bits = new Uint32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
    this.sort(bits, width, rows);
  }

  /**
   * Neighbours in a line that see the same make one rectangle.
   * @param {Uint32Array} bits
   * @param {number} width
   * @param {number} rows
   */
  sort(bits, width, rows) {
    const corners = [];
    this.places.clear();
    for (let row = 0; row < rows; ++row) {
      const bit = row & 31;
      for (const sewn of [0, 1]) {
        const begin = corners.length / 2;
        for (let k = 0; k < bits.length / 4;) {
          const y = Math.floor(k / width), start = k;
          const same = () => Math.floor(k / width) === y && bits[4 * k] >>> bit & 1 && (bits[4 * k + 1] >>> bit & 1) === sewn;
          while (same()) ++k;
          if (k === start) {
            ++k;
            continue;
          }
          const [x0, x1, y0, y1] = [start - y * width, k - y * width, y, y + 1].map((n) => TILE * n);
          corners.push(x0, y0, x1, y0, x1, y1, x0, y0, x1, y1, x0, y1);
        }
        this.places.set(`${row} ${sewn}`, [begin, corners.length / 2 - begin]);
      }
    }
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.buffer);
    this.gl.bufferData(this.gl.ARRAY_BUFFER, Uint16Array.from(corners), this.gl.DYNAMIC_DRAW);
  }

  /**
   * Whether a row is seen at all, with seams near or without.
   * @param {number} row
   * @param {boolean} sewn
   */
  has(row, sewn) {
    return (this.places.get(`${row} ${Number(sewn)}`)?.[1] ?? 0) > 0;
  }

  /** @param {number} row @param {boolean} sewn */
  draw(row, sewn) {
    const { gl } = this;
    const [first, count] = this.places.get(`${row} ${Number(sewn)}`) ?? [0, 0];
    gl.bindVertexArray(this.array);
    gl.disable(gl.DEPTH_TEST);
    gl.drawArrays(gl.TRIANGLES, first, count);
    gl.enable(gl.DEPTH_TEST);
  }
}
