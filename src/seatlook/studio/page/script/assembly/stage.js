// The seat before it is solved, in WebGL: foam and panels lit from above, lines of one width over them.

import { programOf, use } from "../../../../report/viewer/script/drawing/gl.js";

/** @typedef {import("../../../../report/viewer/script/drawing/camera.js").Camera} Camera */
/** @typedef {{name: string, vertices: Float32Array, triangles: Uint32Array, colour: number[], lit: boolean,
 *   shift: number[], array: WebGLVertexArrayObject | null}} Body */
/** @typedef {{points: number[][], colour: number[], width: number, lift: number}} Line points [m] in pairs */

const BODY_VERTEX = `
layout(location = 0) in vec3 aPlace;
uniform mat4 uCamera;
uniform vec3 uShift;
out vec3 vPlace;
void main() {
  vPlace = aPlace + uShift;
  gl_Position = uCamera * vec4(vPlace, 1.0);
}
`;

const BODY_FRAGMENT = `
in vec3 vPlace;
uniform vec3 uColour, uEye;
uniform float uLit;
out vec4 oColour;
void main() {
  vec3 normal = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
  vec3 eye = normalize(uEye - vPlace);
  if (dot(normal, eye) < 0.0) normal = -normal;
  float light = 0.42 + 0.38 * max(0.0, normal.z) + 0.28 * max(0.0, dot(normal, eye));
  oColour = vec4(mix(uColour * light, vec3(1.0, 0.82, 0.25), 0.35 * uLit), 1.0);
}
`;

// Each piece of a line is a flat ribbon, as many pixels wide wherever it lies.
const LINE_VERTEX = `
layout(location = 0) in vec3 aStart;
layout(location = 1) in vec3 aEnd;
layout(location = 2) in vec2 aCorner;
uniform mat4 uCamera;
uniform vec2 uSize;
uniform float uWidth, uLift;
void main() {
  vec4 a = uCamera * vec4(aStart, 1.0), b = uCamera * vec4(aEnd, 1.0);
  vec2 way = (b.xy / b.w - a.xy / a.w) * uSize;
  vec2 along = length(way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
  vec4 at = mix(a, b, aCorner.x);
  vec2 side = vec2(-along.y, along.x) * aCorner.y + along * (aCorner.x * 2.0 - 1.0) * 0.5;
  at.xy += side * uWidth / uSize * at.w;
  at.z -= uLift * at.w;
  gl_Position = at;
}
`;

const LINE_FRAGMENT = `
uniform vec3 uColour;
uniform float uAlpha;
out vec4 oColour;
void main() { oColour = vec4(uColour, uAlpha); }
`;

export class Stage {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser draws no WebGL 2");
    this.canvas = canvas;
    this.gl = gl;
    this.bodyProgram = programOf(gl, BODY_VERTEX, BODY_FRAGMENT);
    this.lineProgram = programOf(gl, LINE_VERTEX, LINE_FRAGMENT);
    /** @type {Body[]} */
    this.bodies = [];
    /** @type {{array: WebGLVertexArrayObject | null, buffer: WebGLBuffer | null, count: number, line: Line}[]} */
    this.lines = [];
    gl.enable(gl.DEPTH_TEST);
  }

  /**
   * @param {string} name
   * @param {number[]} places [mm] row after row
   * @param {number[]} triangles
   * @param {number[]} colour
   */
  bodyOf(name, places, triangles, colour) {
    const { gl } = this;
    const vertices = Float32Array.from(places, (x) => x / 1e3), indices = Uint32Array.from(triangles);
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { name, vertices, triangles: indices, colour, lit: false, shift: [0, 0, 0], array };
  }

  /** @param {Body[]} bodies */
  setBodies(bodies) {
    for (const { array } of this.bodies) this.gl.deleteVertexArray(array);
    this.bodies = bodies;
  }

  /** @param {Line[]} lines */
  setLines(lines) {
    const { gl } = this;
    for (const { array, buffer } of this.lines) {
      gl.deleteVertexArray(array);
      gl.deleteBuffer(buffer);
    }
    this.lines = lines.filter(({ points }) => points.length > 1).map((line) => this.lineOf(line));
  }

  /** @param {Line} line */
  lineOf(line) {
    const { gl } = this;
    const data = [];
    for (let k = 0; k + 1 < line.points.length; k += 2) {
      const ends = [...line.points[k], ...line.points[k + 1]];
      for (const corner of [[0, -1], [1, -1], [1, 1], [0, -1], [1, 1], [0, 1]]) data.push(...ends, ...corner);
    }
    const array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(data), gl.STATIC_DRAW);
    for (const [place, size, at] of [[0, 3, 0], [1, 3, 12], [2, 2, 24]]) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 32, at);
    }
    gl.bindVertexArray(null);
    return { array, buffer, count: data.length / 8, line };
  }

  /** Middle and reach of all bodies. */
  measure() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const { vertices } of this.bodies) {
      for (let k = 0; k < vertices.length; ++k) {
        low[k % 3] = Math.min(low[k % 3], vertices[k]);
        high[k % 3] = Math.max(high[k % 3], vertices[k]);
      }
    }
    if (!Number.isFinite(low[0])) return { middle: [0, 0, 0], reach: 0.5 };
    return {
      middle: low.map((x, i) => (x + high[i]) / 2), reach: Math.max(0.55 * Math.hypot(...low.map((x, i) => high[i] - x)), 0.05),
    };
  }

  /** @param {Camera} camera @param {{middle: number[], reach: number}} whole @param {number[]} paper colour behind all */
  draw(camera, whole, paper) {
    const { gl, canvas } = this;
    const { width, height } = canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(paper[0], paper[1], paper[2], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const matrix = camera.matrix(width / height, 1.6 * whole.reach, whole.middle);
    for (const body of this.bodies) {
      use(gl, this.bodyProgram, {
        uCamera: matrix, uColour: body.colour, uEye: camera.position, uLit: Number(body.lit), uShift: body.shift,
      });
      gl.bindVertexArray(body.array);
      gl.drawElements(gl.TRIANGLES, body.triangles.length, gl.UNSIGNED_INT, 0);
    }
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    // Faintly where something is in front, fully where they are seen.
    for (const [test, alpha] of [[gl.GREATER, 0.22], [gl.LEQUAL, 1]]) {
      gl.depthFunc(test);
      gl.depthMask(false);
      for (const { array, count, line } of this.lines) {
        use(gl, this.lineProgram, {
          uCamera: matrix, uSize: [width, height], uWidth: line.width * window.devicePixelRatio, uLift: line.lift,
          uColour: line.colour, uAlpha: alpha,
        });
        gl.bindVertexArray(array);
        gl.drawArrays(gl.TRIANGLES, 0, count);
      }
    }
    gl.depthMask(true);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  /**
   * The first body that a ray meets.
   * @param {number[]} origin
   * @param {number[]} ray
   * @returns {{body: Body, place: number[], away: number} | null}
   */
  hit(origin, ray) {
    let best = null, nearest = Infinity;
    for (const body of this.bodies) {
      const away = nearestHit(body, origin.map((x, i) => x - body.shift[i]), ray);
      if (away < nearest) [best, nearest] = [body, away];
    }
    return best ? { body: best, away: nearest, place: origin.map((x, i) => x + nearest * ray[i]) } : null;
  }
}

/** Möller and Trumbore. @param {Body} body @param {number[]} origin @param {number[]} ray */
function nearestHit({ vertices: x, triangles }, origin, ray) {
  let nearest = Infinity;
  for (let k = 0; k < triangles.length; k += 3) {
    const a = 3 * triangles[k], b = 3 * triangles[k + 1], c = 3 * triangles[k + 2];
    const e1 = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]];
    const e2 = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
    const p = [ray[1] * e2[2] - ray[2] * e2[1], ray[2] * e2[0] - ray[0] * e2[2], ray[0] * e2[1] - ray[1] * e2[0]];
    const det = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
    if (Math.abs(det) < 1e-14) continue;
    const s = [origin[0] - x[a], origin[1] - x[a + 1], origin[2] - x[a + 2]];
    const u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / det;
    if (u < 0 || u > 1) continue;
    const q = [s[1] * e1[2] - s[2] * e1[1], s[2] * e1[0] - s[0] * e1[2], s[0] * e1[1] - s[1] * e1[0]];
    const v = (ray[0] * q[0] + ray[1] * q[1] + ray[2] * q[2]) / det;
    if (v < 0 || u + v > 1) continue;
    const t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / det;
    if (t > 1e-6 && t < nearest) nearest = t;
  }
  return nearest;
}
