// Where the seat is seen from: around a target, at a distance, as in the named views of pictures.

import { along, anglesOf, cross, lookAt, minus, norm, perspective, product, towards, unit } from "./matrix.js";

/** @typedef {import("./payload.js").View} View */
/** @typedef {{target: number[], azimuth: number, elevation: number, distance: number, fov: number,
 *   aspect: number, view: string}} State */

const STEEPEST = Math.PI / 2;
const NEAREST = 0.03;

/**
 * @param {View} view
 * @returns {State}
 */
export function stateOf(view) {
  const away = minus(view.position, view.target);
  let [azimuth, elevation] = anglesOf(away);
  // Seen from straight above, the picture's upper edge says how the seat is turned.
  if (STEEPEST - elevation < 1e-4) [azimuth, elevation] = [Math.atan2(-view.up[0], view.up[1]), STEEPEST];
  return {
    target: [...view.target], azimuth, elevation, distance: norm(away), fov: view.fov,
    aspect: view.size[0] / view.size[1], view: view.name,
  };
}

export class Camera {
  /** @param {View} view */
  constructor(view) {
    this.state = stateOf(view);
    this.farthest = 6 * this.state.distance;
  }

  get position() {
    const { target, azimuth, elevation, distance } = this.state;
    return along(target, distance, towards(azimuth, elevation));
  }

  get up() {
    const { azimuth, elevation } = this.state;
    return towards(azimuth + Math.PI, STEEPEST - elevation);
  }

  /**
   * Tangent of half the vertical field of view in a picture of this aspect: what was seen across or
   * upright is seen whole.
   * @param {number} aspect
   */
  half(aspect) {
    const half = Math.tan(this.state.fov * Math.PI / 360);
    return aspect < this.state.aspect ? half * this.state.aspect / aspect : half;
  }

  /**
   * @param {number} aspect
   * @param {number} reach radius of the seat around its middle, for the planes between which is drawn
   * @param {number[]} middle
   * @param {number[]} shift
   */
  matrix(aspect, reach, middle, shift = [0, 0]) {
    const [near, far] = this.planes(reach, middle);
    const view = lookAt(this.position, this.state.target, this.up);
    return product(perspective(this.half(aspect), aspect, near, far, shift), view);
  }

  /** Distances between which is drawn. @param {number} reach @param {number[]} middle */
  planes(reach, middle) {
    const away = norm(minus(this.position, middle));
    return [Math.max(away - reach, 0.01), away + reach];
  }

  /**
   * The matrix for shaders, and what they need to find a place again by its pixel and depth.
   * @param {number} aspect
   * @param {number} reach
   * @param {number[]} middle
   * @param {number[]} shift
   */
  uniforms(aspect, reach, middle, shift) {
    const ahead = unit(minus(this.state.target, this.position)), right = unit(cross(ahead, this.up));
    const half = this.half(aspect);
    return {
      uCamera: this.matrix(aspect, reach, middle, shift), uEye: this.position, uAlong: ahead, uShift: shift,
      uRight: right.map((c) => half * aspect * c), uTop: cross(right, ahead).map((c) => half * c),
      uPlanes: this.planes(reach, middle),
    };
  }

  /**
   * Unit direction through a place of the picture, x and y from -1 to 1.
   * @param {number} x
   * @param {number} y
   * @param {number} aspect
   */
  ray(x, y, aspect) {
    const ahead = unit(minus(this.state.target, this.position));
    const right = unit(cross(ahead, this.up));
    const top = cross(right, ahead);
    const half = this.half(aspect);
    return unit(along(along(ahead, x * half * aspect, right), y * half, top));
  }

  /** @param {number} azimuth @param {number} elevation */
  turn(azimuth, elevation) {
    this.state.azimuth += azimuth;
    this.state.elevation = Math.min(STEEPEST, Math.max(-STEEPEST, this.state.elevation + elevation));
  }

  /**
   * Shift the seat in the picture by shares of its height.
   * @param {number} x
   * @param {number} y
   */
  pan(x, y) {
    const ahead = unit(minus(this.state.target, this.position));
    const right = unit(cross(ahead, this.up));
    const size = 2 * this.state.distance * Math.tan(this.state.fov * Math.PI / 360);
    this.state.target = along(along(this.state.target, -x * size, right), y * size, cross(right, ahead));
  }

  /** @param {number} times */
  zoom(times) {
    this.state.distance = Math.min(this.farthest, Math.max(NEAREST, this.state.distance / times));
  }

  /**
   * Look at a place from the side that it faces, from so far that its length fills a third.
   * @param {number[]} place
   * @param {number[]} normal
   * @param {number} length
   */
  flyTo(place, normal, length) {
    const [azimuth, elevation] = anglesOf(normal);
    const half = Math.tan(this.state.fov * Math.PI / 360);
    const distance = Math.max(1.5 * Math.max(length, 0.03) / half, NEAREST);
    // From a little aside: a wrinkle shows by its shade.
    Object.assign(this.state, {
      target: [...place], azimuth, distance, elevation: Math.max(elevation - 0.35, -STEEPEST),
    });
  }
}
