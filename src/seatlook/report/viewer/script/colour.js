// Colours as people give them: linear sRGB, hex, CIE L*a*b* under D65; see model/colour.py.

const WHITE = [0.95047, 1.0, 1.08883];
const TO_SRGB = [
  [3.2404542, -1.5371385, -0.4985314], [-0.969266, 1.8760108, 0.041556], [0.0556434, -0.2040259, 1.0572252],
];
const TO_XYZ = [
  [0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.072175], [0.0193339, 0.119192, 0.9503041],
];
const BEND = 6 / 29;

/** @param {number} x */
const encode = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * Math.pow(x, 1 / 2.4) - 0.055);
/** @param {number} x */
const decode = (x) => (x <= 0.04045 ? x / 12.92 : Math.pow((x + 0.055) / 1.055, 2.4));

/** @param {number[]} linear */
export function hexOf(linear) {
  const code = (/** @type {number} */ x) => Math.round(255 * encode(Math.min(1, Math.max(0, x))));
  return `#${linear.map((x) => code(x).toString(16).padStart(2, "0")).join("")}`;
}

/**
 * Linear numbers of "#rrggbb", or null.
 * @param {string} text
 */
export function fromHex(text) {
  const found = /^#?([0-9a-f]{6})$/i.exec(text.trim());
  if (!found) return null;
  return [0, 2, 4].map((k) => decode(parseInt(found[1].slice(k, k + 2), 16) / 255));
}

/** @param {number[]} linear */
export function labOf(linear) {
  const f = TO_XYZ.map((row, i) => {
    const t = row.reduce((sum, weight, k) => sum + weight * linear[k], 0) / WHITE[i];
    return t > BEND ** 3 ? Math.cbrt(t) : t / (3 * BEND * BEND) + 4 / 29;
  });
  return [116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])];
}

/**
 * Linear numbers of "L, a, b", or null where no display shows the colour.
 * @param {string} text
 */
export function fromLab(text) {
  const numbers = text.split(/[\s,;]+/).filter(Boolean).map(Number);
  if (numbers.length !== 3 || numbers.some((x) => !Number.isFinite(x))) return null;
  const [lightness, a, b] = numbers;
  const y = (lightness + 16) / 116;
  const xyz = [y + a / 500, y, y - b / 200].map(
    (f, i) => WHITE[i] * (f > BEND ? f ** 3 : 3 * BEND * BEND * (f - 4 / 29)),
  );
  const linear = TO_SRGB.map((row) => row.reduce((sum, weight, k) => sum + weight * xyz[k], 0));
  if (linear.some((x) => x < -1e-3 || x > 1.001)) return null;
  return linear.map((x) => Math.min(1, Math.max(0, x)));
}
