// Materials, tables, reliefs and an own picture of fabric, on the card.

import { ALL, BRDF, COUPLING, MATERIALS, termsOf } from "./glsl_brdf.js";
import { WHOLE, bind, fill, floatTable, newTexture, programOf, sampling, targetOf, use } from "./gl.js";

/** @typedef {import("./payload.js").Content} Content */
/** @typedef {import("./payload.js").Material} Material */
/** @typedef {import("./payload.js").Numbers} Numbers */

const NODES = 80;
const STRETCHED = 1e-5;

/**
 * Tables of the lobes' albedos, see pbr/reflectance/tables.py.
 * @param {WebGL2RenderingContext} gl
 * @param {(name: string) => Numbers} array
 * @param {boolean} stretched whether any material's lobe is stretched
 */
export function tablesOf(gl, array, stretched) {
  const albedos = /** @type {Float32Array} */ (array("albedos"));
  const none = floatTable(gl, 1, 1, 1, new Float32Array(1));
  return {
    uAlbedos: floatTable(gl, albedos.length / 3 / NODES, NODES, 3, albedos),
    uMeans: floatTable(gl, NODES, 1, 2, /** @type {Float32Array} */ (array("means"))),
    uStretched: stretched
      ? floatTable(gl, 9 * 20, 16 * 9, 2, Float32Array.from(array("stretched"), (value) => STRETCHED * value)) : none,
    uStretchedMeans: stretched
      ? floatTable(gl, 9, 16, 1, /** @type {Float32Array} */ (array("stretched means"))) : none,
  };
}

/** A material as four texels. @param {Material} m */
export function texelsOf(m) {
  return [
    ...m.albedo, m.metalness, ...m.sheen, m.sheen_roughness,
    m.coat, m.coat_roughness, m.anisotropy, 0, m.roughness, m.f0, 0, 0,
  ];
}

/** The table of materials and, drawn from it, that of their couplings. */
export class MaterialTable {
  /**
   * @param {WebGL2RenderingContext} gl
   * @param {Record<string, WebGLTexture>} tables
   * @param {import("./gl.js").Program} [program] of another table
   */
  constructor(gl, tables, program) {
    this.gl = gl;
    this.tables = tables;
    this.program = program ?? programOf(gl, WHOLE, termsOf(ALL) + BRDF + MATERIALS + COUPLING);
    /** @type {WebGLTexture | null} */
    this.rows = null;
    /** @type {ReturnType<typeof targetOf> | null} */
    this.couplings = null;
  }

  /** @param {Material[]} materials */
  fill(materials) {
    const gl = this.gl;
    gl.deleteTexture(this.rows);
    this.couplings?.drop();
    const data = Float32Array.from(materials.flatMap(texelsOf));
    this.rows = floatTable(gl, 4, materials.length, 4, data);
    this.couplings = targetOf(gl, NODES, materials.length, gl.RGBA32F, false);
    gl.viewport(0, 0, NODES, materials.length);
    use(gl, this.program, {});
    bind(gl, this.program, { ...this.tables, uMaterials: this.rows });
    fill(gl);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  get textures() {
    return { ...this.tables, uMaterials: this.rows, uCouplings: this.couplings?.texture ?? null };
  }
}

/**
 * Reliefs by their names: slopes, their mean square, and share of the colour, with all levels.
 * @param {WebGL2RenderingContext} gl
 * @param {Content} content
 * @param {(name: string) => Numbers} array
 */
export function reliefsOf(gl, content, array) {
  /** @type {Record<string, WebGLTexture>} */
  const out = {};
  for (const [name, relief] of Object.entries(content.reliefs)) {
    const slopes = array(`slopes ${name}`), rest = array(`rest ${name}`);
    const texels = new Float32Array(2 * slopes.length);
    for (let k = 0; k < slopes.length / 2; ++k) {
      const u = slopes[2 * k] / 127 * relief.steep, v = slopes[2 * k + 1] / 127 * relief.steep;
      const root = rest[2 * k] / 255;
      texels.set([u, v, relief.variance * root * root + 0.5 * (u * u + v * v), rest[2 * k + 1] / 255], 4 * k);
    }
    out[name] = newTexture(gl);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, relief.size, relief.size, 0, gl.RGBA, gl.FLOAT, texels);
    gl.generateMipmap(gl.TEXTURE_2D);
    sampling(gl, gl.LINEAR_MIPMAP_LINEAR, gl.LINEAR, gl.REPEAT);
  }
  return out;
}

/**
 * A picture as a colour map with all levels, linear once read.
 * @param {WebGL2RenderingContext} gl
 * @param {ImageBitmap} picture
 */
export function photoTexture(gl, picture) {
  const texture = newTexture(gl);
  gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
  gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
  gl.generateMipmap(gl.TEXTURE_2D);
  sampling(gl, gl.LINEAR_MIPMAP_LINEAR, gl.LINEAR, gl.REPEAT);
  return texture;
}

const RELIEF_CODES = { none: -1, leather: 0, suede: 1, weave: 2 };

/**
 * What a shader needs for a material, by name.
 * @param {Material} m
 * @param {boolean} photo whether a picture is laid over it
 * @returns {Record<string, boolean>}
 */
export function needsOf(m, photo) {
  return {
    coat: m.coat > 0, sheen: Math.max(...m.sheen) > 0, metal: m.metalness > 0, stretch: m.anisotropy !== 0,
    relief: m.texture !== "none" && m.texture_depth > 0, nap: m.texture === "suede",
    holes: m.perforation_diameter > 0, photo,
  };
}

/**
 * Uniforms and textures of the detail of a material.
 * @param {Material} m
 * @param {Content} content
 * @param {Record<string, WebGLTexture>} reliefs
 */
export function detailOf(m, content, reliefs) {
  const relief = content.reliefs[m.texture];
  const known = relief && m.texture_depth > 0;
  return {
    texture: known ? reliefs[m.texture] : null,
    uniforms: {
      uTexture: known ? /** @type {Record<string, number>} */ (RELIEF_CODES)[m.texture] : -1,
      uRelief: known ? [relief.cells * m.texture_scale, relief.size, 0] : [1, 1, 0],
      uGrain: [m.texture_scale, m.texture_depth],
      uHoles: [m.perforation_pitch, m.perforation_diameter],
    },
  };
}
