// The lights of a rig as shaders take them, and the way to where each shines.

import { MOST_LIGHTS } from "./glsl_surface.js";
import { along, anglesOf, cross, dot, lookAt, minus, norm, orthographic, perspective, product, towards, unit } from "./matrix.js";

/** @typedef {import("./payload.js").Light} Light */
/** @typedef {import("./payload.js").Rig} Rig */

// Widest angle [rad] of a shadow map, of a lamp amid the seat.
const WIDEST = 2.6;

/** Two unit vectors across a direction. @param {number[]} l */
function across(l) {
  const a = Math.abs(l[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
  const t = unit(cross(l, a));
  return [t, cross(l, t)];
}

/**
 * A point of the unit disc; Roberts 2018 spreads numbers evenly, Shirley and Chiu 1997 map them.
 * Two by two they lie opposite: however few, their mean is the middle, or the light would shift.
 * @param {number} index
 */
export function discPoint(index) {
  // From the seventh on, also the first two pairs fill the disc as evenly as can be.
  const pair = (index >> 1) + 7, side = index & 1 ? -1 : 1;
  const a = 2 * ((0.5 + 0.7548776662466927 * pair) % 1) - 1;
  const b = 2 * ((0.5 + 0.5698402909980532 * pair) % 1) - 1;
  const [r, phi] = Math.abs(a) > Math.abs(b)
    ? [a, Math.PI / 4 * b / a] : [b, Math.PI / 2 - Math.PI / 4 * a / b];
  return [side * r * Math.cos(phi), side * r * Math.sin(phi)];
}

/**
 * Vector of a light from one of its points.
 * @param {Light} light
 * @param {number[]} middle of the seat
 * @param {number[]} point of the unit disc
 */
function pointOf(light, middle, point) {
  if (light.sides) {
    const [a, b] = light.sides;
    return along(along(light.vector, point[0], a), point[1], b);
  }
  const to = light.near ? minus(light.vector, middle) : light.vector;
  const [t, s] = across(unit(to));
  const half = light.near ? light.size : Math.tan(light.size / 2);
  const place = along(along(light.vector, half * point[0], t), half * point[1], s);
  return light.near ? place : unit(place);
}

/**
 * Uniforms of the lights seen from one point of each, and their shadow maps' matrices.
 * @param {Rig} rig
 * @param {{middle: number[], reach: number}} seat
 * @param {number[]} point of the unit disc
 * @param {number} texels across a shadow map
 */
export function lightsOf(rig, seat, point, texels) {
  const vector = new Float32Array(4 * MOST_LIGHTS), intensity = new Float32Array(3 * MOST_LIGHTS);
  const ahead = new Float32Array(4 * MOST_LIGHTS), size = new Float32Array(2 * MOST_LIGHTS);
  const shadow = new Float32Array(16 * MOST_LIGHTS);
  rig.lights.forEach((light, k) => {
    const place = pointOf(light, seat.middle, point);
    // A narrow light has one map, from its middle.
    const from = isWide(light, seat.middle) ? place : pointOf(light, seat.middle, [0, 0]);
    const [matrix, texel] = shadowMatrix(light, from, seat, texels);
    vector.set([...place, light.near ? 1 : 0], 4 * k);
    // All points of a bulb together light as its middle does.
    const nearer = light.near && !light.sides ? norm(minus(place, seat.middle)) / norm(minus(light.vector, seat.middle)) : 1;
    intensity.set(light.colour.map((c) => c * light.intensity * nearer ** 3), 3 * k);
    shadow.set(matrix, 16 * k);
    // Of a rectangle, points are drawn out of its sides: none of it is left to widen a lobe.
    const angle = light.sides ? 0 : light.near ? light.size : light.size / 2;
    size.set([angle, texel], 2 * k);
    if (light.sides) {
      const n = unit(cross(light.sides[0], light.sides[1]));
      ahead.set([-n[0], -n[1], -n[2], light.twoSided ? 2 : 1], 4 * k);
    }
  });
  return {
    uniforms: { uLights: rig.lights.length, uVector: vector, uIntensity: intensity, uAhead: ahead, uLightSize: size, uShadow: shadow },
    shadow,
  };
}

/**
 * From the world to a shadow map, and the size of its texels: [m], or [rad] of a near light.
 * @param {Light} light
 * @param {number[]} place
 * @param {{middle: number[], reach: number}} seat
 * @param {number} texels
 * @returns {[Float64Array, number]}
 */
function shadowMatrix(light, place, seat, texels) {
  const { middle, reach } = seat;
  if (!light.near) {
    const eye = along(middle, reach, place);
    return [product(orthographic(reach, 2 * reach), lookAt(eye, middle, [0, 0, 1])), 2 * reach / texels];
  }
  const away = norm(minus(place, middle));
  const half = Math.tan(Math.min(away > reach ? Math.asin(reach / away) : WIDEST / 2, WIDEST / 2));
  const near = Math.max(away - reach, 0.01);
  const matrix = product(perspective(half, 1, near, away + reach), lookAt(place, middle, [0, 0, 1]));
  return [matrix, 2 * half / texels];
}

/** Whether shadows of a light are soft enough to show. @param {Light} light @param {number[]} middle */
export function isWide(light, middle) {
  if (light.sides) return true;
  return (light.near ? 2 * light.size / norm(minus(light.vector, middle)) : light.size) > 0.01;
}

/**
 * Azimuth and elevation [rad] of a light, and how far [m] it is from the middle of the seat.
 * @param {Light} light
 * @param {number[]} middle
 */
export function placeOf(light, middle) {
  const to = light.near ? minus(light.vector, middle) : light.vector;
  const [azimuth, elevation] = anglesOf(to);
  return { azimuth, elevation, distance: light.near ? norm(to) : 0 };
}

/**
 * The same light elsewhere. A rectangle goes on facing what it faces, and its first side points where
 * it did, as far as that lies across: as a scene with another `position_mm` has it.
 * @param {Light} light
 * @param {number[]} middle
 * @param {{azimuth: number, elevation: number, distance: number}} place
 * @returns {Light}
 */
export function moved(light, middle, place) {
  const to = towards(place.azimuth, place.elevation);
  const vector = light.near ? along(middle, place.distance, to) : to;
  if (!light.sides) return { ...light, vector };
  const [a, b] = light.sides;
  const ahead = unit(minus(aimOf(light, middle), vector));
  const first = along(a, -dot(a, ahead), ahead), second = along(b, -dot(b, ahead), ahead);
  // A first side that points at the seat leaves the second one to say how the light is turned.
  const t = norm(first) > 1e-3 * norm(a) ? unit(first) : unit(cross(second, ahead));
  return { ...light, vector, sides: [along([0, 0, 0], norm(a), t), along([0, 0, 0], norm(b), cross(ahead, t))] };
}

/** The place ahead of a rectangle that is nearest to the middle of the seat. @param {Light} light @param {number[]} middle */
function aimOf({ vector, sides }, middle) {
  if (!sides) return middle;
  const ahead = unit(cross(sides[0], sides[1]));
  const far = dot(minus(middle, vector), ahead);
  return far > 0 ? along(vector, far, ahead) : middle;
}

/**
 * Illuminance [lux] of a rig on a card that lies at the seat, without shadows.
 * @param {Rig} rig
 * @param {number[]} seat
 */
export function luxAt(rig, seat) {
  const sky = Math.PI * (0.2126 * rig.sky[0] + 0.7152 * rig.sky[1] + 0.0722 * rig.sky[2]);
  return rig.lights.reduce((sum, light) => {
    const to = light.near ? minus(light.vector, seat) : light.vector;
    const far = norm(to);
    const ahead = light.sides ? -(/** @type {number} */ (dotUnit(light.sides, to))) / far : 1;
    const facing = light.twoSided ? Math.abs(ahead) : Math.max(0, ahead);
    return sum + light.intensity * facing * Math.max(0, to[2] / far) / (light.near ? far * far : 1);
  }, sky);
}

/** @param {number[][]} sides @param {number[]} to */
function dotUnit(sides, to) {
  const n = unit(cross(sides[0], sides[1]));
  return n[0] * to[0] + n[1] * to[1] + n[2] * to[2];
}
