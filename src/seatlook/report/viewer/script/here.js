// What is known of a place of the seat.

import { minus, norm } from "./drawing/matrix.js";

/** @typedef {import("./drawing/payload.js").Content} Content */
/** @typedef {import("./drawing/payload.js").Numbers} Numbers */

export class Knowledge {
  /**
   * @param {Content} content
   * @param {(name: string) => Numbers} array
   */
  constructor(content, array) {
    this.content = content;
    this.values = content.maps.map((map) => array(`faces ${map.name}`));
    this.strain = array("strain");
    this.points = content.seams.length ? array("seam points") : new Float32Array();
    this.numbers = content.seams.length ? array("seam numbers") : new Uint16Array();
  }

  /**
   * @param {import("./drawing/mesh.js").Mesh} mesh
   * @param {import("./drawing/mesh.js").Hit} hit
   */
  at(mesh, hit) {
    const part = this.content.parts[hit.part].name;
    const face = mesh.solverFace(hit);
    if (face < 0) return `${part}.`;
    const [u, v] = mesh.patternAt(hit).map((x) => (1e3 * x).toFixed(0));
    const maps = this.content.maps.map((map, k) => {
      const value = this.values[k][face];
      const unit = map.unit === "1" ? "" : ` ${map.unit}`;
      return Number.isFinite(value) ? `${map.name} ${value.toFixed(2)}${unit}` : `${map.name} not known`;
    });
    const seam = this.nearestSeam(hit.place);
    const [along, across] = [0, 1].map((k) => `${this.strain[2 * face + k].toFixed(1)} %`);
    return `${part}, pattern u ${u}, v ${v} mm. ${maps.join(", ")}.${this.cause(face)}`
      + ` Strain ${along} along the grain, ${across} across.`
      + (seam ? ` Nearest seam: ${seam.name}, ${(1e3 * seam.away).toFixed(0)} mm away.` : "");
  }

  /** The larger part of a W2 that counts. @param {number} face */
  cause(face) {
    const [w2, stretch, compression] = this.values.map((values) => values[face]);
    if (!(w2 > 0.1)) return "";
    return ` Mostly by ${stretch > compression ? "stretch" : "compression"}.`;
  }

  /** @param {number[]} place */
  nearestSeam(place) {
    let away = Infinity, number = -1;
    for (let k = 0; k < this.numbers.length; ++k) {
      const d = norm(minus([this.points[3 * k], this.points[3 * k + 1], this.points[3 * k + 2]], place));
      if (d < away) [away, number] = [d, this.numbers[k]];
    }
    return number < 0 ? null : { name: this.content.seams[number], away };
  }
}
