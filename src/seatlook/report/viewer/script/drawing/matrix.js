// Vectors of three numbers, and 4 x 4 matrices column by column.

/** @typedef {ArrayLike<number>} Vector */

/** @param {Vector} a @param {Vector} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {Vector} a @param {Vector} b */
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** a + t b. @param {Vector} a @param {number} t @param {Vector} b */
export const along = (a, t, b) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
/** @param {Vector} a @param {Vector} b */
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
];
/** @param {Vector} a */
export const norm = (a) => Math.sqrt(dot(a, a));
/** @param {Vector} a */
export const unit = (a) => along([0, 0, 0], 1 / Math.max(norm(a), 1e-12), a);

/**
 * Unit vector towards azimuth (from -y, counter-clockwise from above) and elevation [rad].
 * @param {number} azimuth
 * @param {number} elevation
 */
export function towards(azimuth, elevation) {
  const level = Math.cos(elevation);
  return [level * Math.sin(azimuth), -level * Math.cos(azimuth), Math.sin(elevation)];
}

/**
 * Azimuth and elevation [rad] of a direction.
 * @param {Vector} d
 */
export function anglesOf(d) {
  const u = unit(d);
  return [Math.atan2(u[0], -u[1]), Math.asin(Math.min(1, Math.max(-1, u[2])))];
}

/** @param {Vector} a @param {Vector} b */
export function product(a, b) {
  const out = new Float64Array(16);
  for (let c = 0; c < 4; ++c) {
    for (let r = 0; r < 4; ++r) {
      for (let k = 0; k < 4; ++k) out[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    }
  }
  return out;
}

/**
 * From the world to a viewer at a place, who looks along -z.
 * @param {Vector} position
 * @param {Vector} target
 * @param {Vector} up
 */
export function lookAt(position, target, up) {
  const back = unit(minus(position, target));
  let right = cross(up, back);
  if (norm(right) < 1e-6) right = cross([0, 1, 0], back);
  right = unit(right);
  const top = cross(back, right);
  return Float64Array.of(
    right[0], top[0], back[0], 0, right[1], top[1], back[1], 0, right[2], top[2], back[2], 0,
    -dot(right, position), -dot(top, position), -dot(back, position), 1,
  );
}

/**
 * @param {number} half tangent of half the vertical field of view
 * @param {number} aspect
 * @param {number} near
 * @param {number} far
 * @param {number[]} shift of the picture, in shares of half its size
 */
export function perspective(half, aspect, near, far, shift = [0, 0]) {
  return Float64Array.of(
    1 / (half * aspect), 0, 0, 0, 0, 1 / half, 0, 0, shift[0], shift[1], -(far + near) / (far - near), -1,
    0, 0, -2 * far * near / (far - near), 0,
  );
}

/**
 * A box of half width r that begins in front of the viewer.
 * @param {number} r
 * @param {number} depth
 */
export function orthographic(r, depth) {
  return Float64Array.of(1 / r, 0, 0, 0, 0, 1 / r, 0, 0, 0, 0, -2 / depth, 0, 0, 0, -1, 1);
}
