// The content of the page: what is said of the seat, and its arrays.

/** @typedef {{name: string, near: boolean, vector: number[], intensity: number, colour: number[],
 *   size: number, sides: number[][] | null, twoSided: boolean, kind: string, colourKeys: string[]}} Light */
/** @typedef {{name: string, words: string, lights: Light[], sky: number[], ev100: number,
 *   white: number[], lux: number, panorama: boolean,
 *   left: number}} Rig */
/** @typedef {{name: string, position: number[], target: number[], up: number[], fov: number,
 *   size: number[]}} View */
/** @typedef {{albedo: number[], metalness: number, roughness: number, f0: number, sheen: number[],
 *   sheen_roughness: number, coat: number, coat_roughness: number, anisotropy: number,
 *   texture: string, texture_scale: number, texture_depth: number, perforation_pitch: number,
 *   perforation_diameter: number}} Material */
/** @typedef {{cells: number, size: number, steep: number, variance: number}} Relief */
/** @typedef {{low: number[], step: number[]}} Range */
/** @typedef {{type: string, start: number, rows: number, columns: number}} Place */
/** @typedef {{name: string, unit: string, meaning: string, low: number, high: number}} Layer */
/** @typedef {{label: string, cause: string, position: number[], normal: number[],
 *   length: number}} Wrinkle */
/** @typedef {{name: string, first: number, count: number, refined: number}} Part */
/** @typedef {{position: Range, pattern: Range, seam: {reach: number, arc: number}, children: number,
 *   parts: Part[], materials: Material[], looks: {name: string, words: string,
 *   materials: number[]}[], reliefs: Record<string, Relief>, thread: Record<string, any>,
 *   measured: string[], maps: Layer[], rigs: Rig[], views: View[], wrinkles: Wrinkle[],
 *   seams: string[], seat: number[], files: string[], name: string, stretched: boolean,
 *   buffers: {places: Record<string, Place>, content: string}}} Content the first seat, and what all share */
/** @typedef {Content & {others: Partial<Content>[]}} Page */
/** @typedef {Int8Array | Uint8Array | Int16Array | Int32Array | Uint16Array
 *   | Uint32Array | Float32Array} Numbers */

/** @type {Record<string, any>} */
const TYPES = {
  i8: Int8Array, u8: Uint8Array, i16: Int16Array, i32: Int32Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array,
};

/**
 * @param {string} text base64
 * @returns {Uint8Array<ArrayBuffer>}
 */
export function bytesOf(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; ++k) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

/**
 * The arrays by their names, row after row.
 * @param {Content["buffers"]} buffers
 * @returns {Promise<(name: string) => Numbers>}
 */
export async function arraysOf(buffers) {
  const stream = new Blob([bytesOf(buffers.content)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const whole = await new Response(stream).arrayBuffer();
  return (name) => {
    const place = buffers.places[name];
    if (!place) throw new Error(`the page holds no ${name}`);
    const { rows, columns } = place;
    const type = TYPES[place.type];
    const columnwise = new type(whole, place.start, rows * columns);
    const out = new type(rows * columns);
    for (let c = 0; c < columns; ++c) {
      let last = 0;
      for (let r = 0; r < rows; ++r) {
        const value = columnwise[c * rows + r];
        // Whole numbers are sent as differences; storing wraps them to their type.
        out[r * columns + c] = place.type === "f32" ? value : last + value;
        last = out[r * columns + c];
      }
    }
    return out;
  };
}

/**
 * One of the seats of the page: its content, with what all share, and its arrays.
 * @param {Page} page
 * @param {(name: string) => Numbers} shared arrays of the first
 * @param {number} number
 * @returns {Promise<{content: Content, array: (name: string) => Numbers}>}
 */
export async function seatOf(page, shared, number) {
  const other = page.others[number - 1];
  if (!other?.buffers) return { content: page, array: shared };
  return { content: { ...page, ...other }, array: await arraysOf(other.buffers) };
}
