// Thin helpers over WebGL 2: programs, textures, targets.

/** @typedef {{program: WebGLProgram, places: Map<string, {at: WebGLUniformLocation, type: number}>}} Program */
/** @typedef {number | boolean | ArrayLike<number>} Value */

const HEAD = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler2DArrayShadow;
`;

// A triangle that covers the whole picture.
export const WHOLE = `
void main() {
  gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
`;

/**
 * Compile and link; a message of the compiler is thrown.
 * @param {WebGL2RenderingContext} gl
 * @param {string} vertex
 * @param {string} fragment
 * @returns {Program}
 */
export function programOf(gl, vertex, fragment) {
  const program = /** @type {WebGLProgram} */ (gl.createProgram());
  /** @type {Array<[number, string]>} */
  const stages = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]];
  for (const [kind, text] of stages) {
    const shader = /** @type {WebGLShader} */ (gl.createShader(kind));
    gl.shaderSource(shader, HEAD + text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const logs = (gl.getAttachedShaders(program) ?? []).map((shader) => gl.getShaderInfoLog(shader));
    throw new Error([gl.getProgramInfoLog(program), ...logs].filter(Boolean).join("\n"));
  }
  const places = new Map();
  const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
  for (let k = 0; k < count; ++k) {
    const info = /** @type {WebGLActiveInfo} */ (gl.getActiveUniform(program, k));
    const name = info.name.replace("[0]", "");
    places.set(name, { at: gl.getUniformLocation(program, info.name), type: info.type });
  }
  return { program, places };
}

/**
 * Use a program and set its uniforms by their names; those that it does not have are passed over.
 * @param {WebGL2RenderingContext} gl
 * @param {Program} program
 * @param {Record<string, Value>} values
 */
export function use(gl, program, values) {
  gl.useProgram(program.program);
  set(gl, program, values);
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {Program} program
 * @param {Record<string, Value>} values
 */
export function set(gl, program, values) {
  for (const [name, value] of Object.entries(values)) {
    const place = program.places.get(name);
    if (!place) continue;
    const list = typeof value === "object" ? Float32Array.from(value) : [Number(value)];
    switch (place.type) {
      case gl.FLOAT: gl.uniform1fv(place.at, list); break;
      case gl.FLOAT_VEC2: gl.uniform2fv(place.at, list); break;
      case gl.FLOAT_VEC3: gl.uniform3fv(place.at, list); break;
      case gl.FLOAT_VEC4: gl.uniform4fv(place.at, list); break;
      case gl.FLOAT_MAT4: gl.uniformMatrix4fv(place.at, false, list); break;
      default: gl.uniform1iv(place.at, Int32Array.from(list));
    }
  }
}

/**
 * Bind textures to units in their order and tell the program.
 * @param {WebGL2RenderingContext} gl
 * @param {Program} program
 * @param {Record<string, WebGLTexture | null>} textures
 */
export function bind(gl, program, textures) {
  let unit = 0;
  for (const [name, texture] of Object.entries(textures)) {
    const place = program.places.get(name);
    if (!place) continue;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(place.type === gl.SAMPLER_2D_ARRAY_SHADOW ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, texture);
    gl.uniform1i(place.at, unit);
    unit += 1;
  }
}

/**
 * A table of floats, read texel by texel.
 * @param {WebGL2RenderingContext} gl
 * @param {number} width
 * @param {number} height
 * @param {number} channels 1, 2, 3 or 4
 * @param {Float32Array | null} data
 */
export function floatTable(gl, width, height, channels, data) {
  const texture = newTexture(gl);
  const inside = [gl.R32F, gl.RG32F, gl.RGB32F, gl.RGBA32F][channels - 1];
  const format = [gl.RED, gl.RG, gl.RGB, gl.RGBA][channels - 1];
  gl.texImage2D(gl.TEXTURE_2D, 0, inside, width, height, 0, format, gl.FLOAT, data);
  sampling(gl, gl.NEAREST, gl.NEAREST, gl.CLAMP_TO_EDGE);
  return texture;
}

/** @param {WebGL2RenderingContext} gl */
export function newTexture(gl) {
  const texture = /** @type {WebGLTexture} */ (gl.createTexture());
  gl.bindTexture(gl.TEXTURE_2D, texture);
  return texture;
}

/**
 * @param {WebGL2RenderingContext} gl
 * @param {number} smaller
 * @param {number} larger
 * @param {number} wrap
 */
export function sampling(gl, smaller, larger, wrap) {
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, smaller);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, larger);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
}

/**
 * Draw a program over a whole target.
 * @param {WebGL2RenderingContext} gl
 */
export function fill(gl) {
  gl.bindVertexArray(null);
  gl.disable(gl.DEPTH_TEST);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  gl.enable(gl.DEPTH_TEST);
}

/**
 * A picture that is drawn into.
 * @param {WebGL2RenderingContext} gl
 * @param {number} width
 * @param {number} height
 * @param {number} inside such as gl.RGBA16F
 * @param {boolean} depth
 */
export function targetOf(gl, width, height, inside, depth) {
  const texture = newTexture(gl);
  gl.texStorage2D(gl.TEXTURE_2D, 1, inside, width, height);
  sampling(gl, gl.NEAREST, gl.NEAREST, gl.CLAMP_TO_EDGE);
  const frame = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  let buffer = null;
  if (depth) {
    buffer = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, buffer);
  }
  const drop = () => {
    gl.deleteFramebuffer(frame);
    gl.deleteTexture(texture);
    gl.deleteRenderbuffer(buffer);
  };
  return { frame, texture, width, height, drop };
}
