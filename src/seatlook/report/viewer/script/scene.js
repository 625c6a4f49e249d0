// What is shown: a light and a material of the page, and what has been changed of them.

import { along, anglesOf, cross, norm, unit } from "./drawing/matrix.js";
import { Camera, stateOf } from "./drawing/camera.js";
import { luxAt, moved, placeOf } from "./drawing/lights.js";

/** @typedef {import("./drawing/payload.js").Content} Content */
/** @typedef {import("./drawing/payload.js").Material} Material */
/** @typedef {{azimuth: number, elevation: number, distance: number}} LightPlace */
/** @typedef {{albedo?: number[], roughness?: number, nap?: number}} Changes */
/** @typedef {{seat: number, beside: number, rig: number, place: LightPlace | null, power: number, follow: boolean, look: number,
 *   changes: Changes, layer: number, camera: import("./drawing/camera.js").State,
 *   photo: {data: string, width: number} | null}} Choice */


export class Scene {
  /** @param {Content} content */
  constructor(content) {
    this.content = content;
    this.camera = new Camera(content.views[0]);
    this.seatNumber = 0;
    this.besideNumber = -1;
    this.rigNumber = 0;
    this.lookNumber = 0;
    /** @type {LightPlace | null} */
    this.place = null;
    this.power = 0;
    this.follow = false;
    /** @type {Changes} */
    this.changes = {};
    this.layer = -1;
  }

  /** @param {import("./drawing/payload.js").View} view */
  view(view) {
    this.camera.state = stateOf(view);
  }

  get lookName() {
    return this.content.looks[this.lookNumber].name;
  }

  /** Whether light or look are no longer those of the scene. */
  get own() {
    return this.place !== null || this.power !== 0 || this.follow || Object.keys(this.changes).length > 0;
  }

  get base() {
    return this.content.rigs[this.rigNumber];
  }

  /** The rig with its light moved and its power changed; the first light is the one that moves. */
  rig(/** @type {number[]} */ middle) {
    const [first, ...others] = this.base.lights;
    if (!first) return this.base;
    const times = Math.pow(2, this.power);
    const light = this.place ? moved(first, middle, this.place) : first;
    return { ...this.base, lights: [{ ...light, intensity: light.intensity * times }, ...others] };
  }

  /**
   * Place of the light that moves.
   * @param {number[]} middle
   */
  lightPlace(middle) {
    const [first] = this.base.lights;
    return this.place ?? (first ? placeOf(first, middle) : { azimuth: 0, elevation: Math.PI / 2, distance: 0 });
  }

  /** Exposure: that of the rig, or from the lux at the seat as the rig has it now. */
  ev100(/** @type {number[]} */ middle) {
    if (!this.follow) return this.base.ev100;
    return Math.log2(Math.max(luxAt(this.rig(middle), this.content.seat), 1e-3) / 2.5);
  }

  /** Material of the largest panel, from which the controls read. */
  get main() {
    const { parts, looks, materials } = this.content;
    let largest = 0;
    parts.slice(0, -1).forEach((part, k) => {
      if (part.refined > parts[largest].refined) largest = k;
    });
    return this.changed(materials[looks[this.lookNumber].materials[largest]]);
  }

  /** @param {Material} m @returns {Material} */
  changed(m) {
    const { albedo, roughness, nap } = this.changes;
    const out = { ...m };
    if (albedo) out.albedo = albedo;
    if (roughness !== undefined) out.roughness = roughness;
    if (nap !== undefined) out.sheen = napOf(out, nap);
    return out;
  }

  /** Materials and the number of each part's among them; the foam, which comes last, keeps its own. */
  materials(content = this.content) {
    const numbers = content.looks[this.lookNumber].materials;
    const cover = numbers.slice(0, -1), foam = numbers[numbers.length - 1];
    const used = [...new Set(cover)];
    const { materials } = content;
    return {
      materials: [...used.map((number) => this.changed(materials[number])), materials[foam]],
      look: [...cover.map((number) => used.indexOf(number)), used.length],
    };
  }

  /** @returns {Omit<Choice, "photo">} */
  choice() {
    return {
      seat: this.seatNumber, beside: this.besideNumber, rig: this.rigNumber, place: this.place, power: this.power, follow: this.follow, look: this.lookNumber,
      changes: this.changes, layer: this.layer, camera: { ...this.camera.state },
    };
  }

  /** @param {Omit<Choice, "photo">} choice */
  choose(choice) {
    this.rigNumber = choice.rig;
    this.place = choice.place;
    this.power = choice.power;
    this.follow = choice.follow;
    this.lookNumber = choice.look;
    this.changes = choice.changes;
    this.layer = choice.layer;
    this.camera.state = choice.camera;
  }

  /** @param {number[]} middle */
  toml(middle) {
    const rig = this.rig(middle);
    const sky = LUMINANCES.reduce((sum, weight, k) => sum + weight * rig.sky[k], 0);
    const lines = [
      "# The light: into the scene.", "[[rig]]", `name = ${JSON.stringify(`${rig.name} moved`)}`,
      `ambient_cd_m2 = ${digits(sky)}`, `ev100 = ${digits(this.ev100(middle))}`,
    ];
    for (const light of rig.lights) lines.push("", ...lightToml(light));
    const m = this.main;
    lines.push(
      "", "# The look: [appearance] of a material's file.", "[appearance]", `albedo = [${m.albedo.map(digits).join(", ")}]`,
    );
    for (const [key, value] of Object.entries({
      metalness: m.metalness, roughness: m.roughness, f0: m.f0, sheen: m.sheen, sheen_roughness: m.sheen_roughness,
      coat: m.coat, coat_roughness: m.coat_roughness, anisotropy: m.anisotropy,
    })) {
      lines.push(`${key} = ${Array.isArray(value) ? `[${value.map(digits).join(", ")}]` : digits(value)}`);
    }
    if (m.texture !== "none") {
      lines.push(`texture = "${m.texture}"`, `texture_scale_mm = ${digits(1e3 * m.texture_scale)}`,
        `texture_depth_mm = ${digits(1e3 * m.texture_depth)}`);
    }
    return `${lines.join("\n")}\n`;
  }
}

const LUMINANCES = [0.2126, 0.7152, 0.0722];

/** @param {number} value */
function digits(value) {
  const text = String(Number(value.toPrecision(6)));
  return /[.e]/.test(text) ? text : `${text}.0`;
}

/** @param {import("./drawing/payload.js").Light} light */
function lightToml(light) {
  const head = "[[rig.light]]";
  const mm = (/** @type {number[]} */ v) => `[${v.map((x) => digits(1e3 * x)).join(", ")}]`;
  if (light.sides) {
    const [a, b] = light.sides;
    return [head, `kind = "${light.kind}"`, `lumen = ${digits(Math.PI * light.intensity * (light.twoSided ? 2 : 1))}`,
      `position_mm = ${mm(light.vector)}`, `target_mm = ${mm(along(light.vector, 1, unit(cross(a, b))))}`,
      `along = [${unit(a).map(digits).join(", ")}]`, `size_mm = ${mm([2 * norm(a), 2 * norm(b)])}`, ...light.colourKeys];
  }
  if (light.near) {
    return [head, 'kind = "bulb"', `lumen = ${digits(4 * Math.PI * light.intensity)}`, `position_mm = ${mm(light.vector)}`,
      `radius_mm = ${digits(1e3 * light.size)}`, ...light.colourKeys];
  }
  const [azimuth, elevation] = anglesOf(light.vector).map((angle) => digits(angle * 180 / Math.PI));
  return [head, `kind = "${light.kind}"`, `illuminance_lux = ${digits(light.intensity)}`, `elevation_deg = ${elevation}`,
    `azimuth_deg = ${azimuth}`, `angular_diameter_deg = ${digits(light.size * 180 / Math.PI)}`, ...light.colourKeys];
}

/**
 * Sheen of a nap of this strength, in the colour that there is or that of the surface.
 * @param {Material} m
 * @param {number} nap
 */
function napOf(m, nap) {
  const most = Math.max(...m.sheen);
  if (most > 0) return m.sheen.map((c) => c / most * nap);
  const brightest = Math.max(...m.albedo, 1e-6);
  return m.albedo.map((c) => c / brightest * nap);
}
