// A panel moved before it is sewn: dragged in the plane of the screen, or by arrow keys.

import { along, cross, minus, norm, unit } from "../../../../report/viewer/script/drawing/matrix.js";
import { choiceField, part, press, put } from "../dom.js";

/** @typedef {import("./room.js").AssemblyRoom} AssemblyRoom */
/** @typedef {import("./stage.js").Body} Body */

const NUDGE = 0.005, ANGLE = Math.PI / 36;

export class Mover {
  /** @param {AssemblyRoom} room */
  constructor(room) {
    this.room = room;
    /** @type {string | null} */
    this.name = null;
    this.moving = false;
    /** @type {{start: number[], depth: number, moved: boolean} | null} */
    this.held = null;
    this.wait = 0;
    const { canvas } = room;
    canvas.addEventListener("pointerdown", (event) => this.down(event), true);
    canvas.addEventListener("pointermove", (event) => this.drag(event), true);
    canvas.addEventListener("pointerup", (event) => this.up(event), true);
    canvas.addEventListener("keydown", (event) => this.key(event), true);
    this.show();
  }

  /** @returns {Body | undefined} */
  get body() {
    return this.name ? this.room.stage?.bodies.find(({ name }) => name === this.name) : undefined;
  }

  /** The panel stays chosen when the seat is drawn anew. */
  keep() {
    if (!this.body) this.name = null;
    this.choose(this.name);
  }

  /** @param {string | null} name of a panel */
  choose(name) {
    this.name = name;
    for (const body of this.room.stage?.bodies ?? []) body.lit = body.name !== "" && body.name === name;
    this.show();
    this.room.redraw();
  }

  show() {
    const panels = this.room.assembly?.panels ?? [];
    const choices = [{ value: "", text: "none" }, ...panels.map(({ name }) => ({ value: name, text: name }))];
    put(part("mover"),
      choiceField("Panel", this.name ?? "", choices, (name) => this.choose(name || null), { "data-key": "mover panel" }),
      press("Move it", () => {
        this.moving = !this.moving;
        this.show();
        if (this.moving) this.room.canvas.focus();
      }, { "aria-pressed": String(this.moving), disabled: !this.name, "data-key": "mover on" }));
    part("mover-hint").hidden = !this.moving;
  }

  /** @param {PointerEvent} event */
  at(event) {
    const area = this.room.canvas.getBoundingClientRect();
    return [2 * (event.clientX - area.left) / area.width - 1, 1 - 2 * (event.clientY - area.top) / area.height];
  }

  /** Place at a depth in front of the eye. @param {number[]} at @param {number} depth */
  placeAt([x, y], depth) {
    const { camera, canvas } = this.room;
    const ray = camera.ray(x, y, canvas.clientWidth / canvas.clientHeight);
    const ahead = unit(minus(camera.state.target, camera.position));
    const slant = ray[0] * ahead[0] + ray[1] * ahead[1] + ray[2] * ahead[2];
    return along(camera.position, depth / slant, ray);
  }

  /** @param {PointerEvent} event */
  down(event) {
    if (!this.moving || event.button !== 0) return;
    const [x, y] = this.at(event), hit = this.room.hit(x, y);
    if (!hit || hit.body.name !== this.name) return;
    const ahead = unit(minus(this.room.camera.state.target, this.room.camera.position));
    const way = minus(hit.place, this.room.camera.position);
    this.held = { start: hit.place, depth: way[0] * ahead[0] + way[1] * ahead[1] + way[2] * ahead[2], moved: false };
    this.room.canvas.setPointerCapture(event.pointerId);
    this.room.canvas.focus({ preventScroll: true });
    event.stopImmediatePropagation();
  }

  /** @param {PointerEvent} event */
  drag(event) {
    const { held, body } = this;
    if (!held || !body) return;
    event.stopImmediatePropagation();
    held.moved = true;
    body.shift = minus(this.placeAt(this.at(event), held.depth), held.start);
    this.room.redraw();
  }

  /** @param {PointerEvent} event */
  up(event) {
    if (!this.held) return;
    event.stopImmediatePropagation();
    const { moved } = this.held;
    this.held = null;
    if (moved) this.send(0);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const { body } = this;
    if (event.key === "Escape" && this.moving) {
      this.moving = false;
      this.show();
    } else if (this.moving && body && !event.ctrlKey && !event.metaKey && !event.altKey) {
      const step = this.stepOf(event.key);
      const turn = { ",": 1, ".": -1 }[event.key];
      if (step) {
        body.shift = along(body.shift, 1, step);
        this.room.redraw();
        // Keys that follow one another are one change.
        clearTimeout(this.wait);
        this.wait = setTimeout(() => this.send(0), 350);
      } else if (turn) this.send(turn * ANGLE);
      else return;
    } else return;
    event.preventDefault();
    event.stopImmediatePropagation();
  }

  /** @param {string} key @returns {number[] | null} [m] */
  stepOf(key) {
    const { camera } = this.room;
    const ahead = unit(minus(camera.state.target, camera.position));
    const right = unit(cross(ahead, camera.up)), up = cross(right, ahead);
    /** @type {Record<string, [number, number[]]>} */
    const ways = {
      ArrowLeft: [-NUDGE, right], ArrowRight: [NUDGE, right], ArrowUp: [NUDGE, up], ArrowDown: [-NUDGE, up],
      PageUp: [NUDGE, ahead], PageDown: [-NUDGE, ahead],
    };
    return ways[key] ? along([0, 0, 0], ways[key][0], ways[key][1]) : null;
  }

  /** Write where the panel is now, turned by an angle about the line of sight. @param {number} angle */
  send(angle) {
    clearTimeout(this.wait);
    const { body, name } = this;
    const { store, camera } = this.room;
    const pose = store.now.placement?.[name ?? ""];
    if (!body || !name) return;
    if (!pose?.rotation || !pose.translation_mm) {
      store.voice.say(`${name} has no place of its own in the scene yet. Lay the panels out first.`, true);
      body.shift = [0, 0, 0];
      this.room.redraw();
      return;
    }
    const shift = body.shift.map((x) => 1e3 * x);
    const turned = turnedPose(pose, meanPlace(body), unit(minus(camera.position, camera.state.target)), angle);
    void store.edit([{
      kind: "pose.set", panel: name, rotation: turned.rotation, translation_mm: turned.translation.map((x, i) => x + shift[i]),
    }], angle ? `${name} is turned by ${Math.round(Math.abs(angle) * 180 / Math.PI)} degrees.` : `${name} is moved by ${norm(shift).toFixed(0)} mm.`);
  }
}

/** Mean of a body's places [mm]. @param {Body} body */
function meanPlace({ vertices }) {
  const sum = [0, 0, 0];
  for (let k = 0; k < vertices.length; ++k) sum[k % 3] += vertices[k];
  return sum.map((x) => 3e3 * x / vertices.length);
}

/**
 * A pose turned about an axis through a place [mm].
 * @param {{rotation: number[][], translation_mm: number[]}} pose
 * @param {number[]} about
 * @param {number[]} axis
 * @param {number} angle
 */
function turnedPose({ rotation, translation_mm: translation }, about, axis, angle) {
  const turn = (/** @type {ArrayLike<number>} */ v) => {
    // Rodrigues: about a unit axis.
    const c = Math.cos(angle), s = Math.sin(angle), sideways = cross(axis, v);
    const share = (1 - c) * (axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2]);
    return [0, 1, 2].map((i) => c * v[i] + s * sideways[i] + share * axis[i]);
  };
  const columns = [0, 1, 2].map((c) => turn(rotation.map((row) => row[c])));
  return {
    rotation: [0, 1, 2].map((r) => columns.map((column) => column[r])),
    translation: turn(minus(translation, about)).map((x, i) => x + about[i]),
  };
}
