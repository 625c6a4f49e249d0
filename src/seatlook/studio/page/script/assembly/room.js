// The assembly: how the cover starts over its foam, what is tied to what, and what cannot be.

import { Camera } from "../../../../report/viewer/script/drawing/camera.js";
import { Pointer } from "../../../../report/viewer/script/pointer.js";
import { draw, find, make, part, press, put } from "../dom.js";
import { Refusal, ask } from "../api.js";
import { FOAM, linesOf, middleOfTie, panelTint, placesOf, tintNumber } from "./content.js";
import { Hooks } from "./hooks.js";
import { Mover } from "./mover.js";
import { Stage } from "./stage.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("./content.js").Assembly} Assembly */
/** @typedef {import("./content.js").Fault} Fault */
/** @typedef {import("./stage.js").Body} Body */

const VIEWS = [
  { name: "front", azimuth: 0.55, elevation: 0.5 }, { name: "rear", azimuth: Math.PI - 0.55, elevation: 0.5 },
  { name: "left", azimuth: Math.PI / 2, elevation: 0.25 }, { name: "top", azimuth: 0, elevation: Math.PI / 2 },
];
const FOV = 28;

export class AssemblyRoom {
  /** @param {Store} store */
  constructor(store) {
    this.store = store;
    this.canvas = find("assembly-canvas", HTMLCanvasElement);
    this.marks = find("assembly-marks", SVGSVGElement);
    /** @type {Assembly | null} */
    this.assembly = null;
    this.etag = "";
    this.open = false;
    /** @type {string | null} */
    this.chosen = null;
    this.whole = { middle: [0, 0, 0], reach: 0.5 };
    this.asked = 0;
    this.light = matchMedia("(prefers-color-scheme: light)");
    this.light.addEventListener("change", () => this.redraw());
    this.camera = new Camera({ name: "front", position: [0.8, -1.2, 0.8], target: [0, 0, 0], up: [0, 0, 1], fov: FOV, size: [16, 10] });
    try {
      this.stage = new Stage(this.canvas);
    } catch (problem) {
      this.stage = null;
      part("assembly-said").textContent = `The seat cannot be drawn: ${problem instanceof Error ? problem.message : problem}.`;
    }
    this.mover = new Mover(this);
    this.hooks = new Hooks(store, () => {
      if (this.assembly) this.lists();
    });
    this.pointer = new Pointer(this.canvas, this.camera, () => this.redraw(), (x, y) => this.pick(x, y));
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    put(part("assembly-views"), ...VIEWS.map((view) => press(view.name, () => this.look(view))));
    part("lay-out").addEventListener("click", () => void this.layOut());
  }

  /** @param {boolean} open whether this room is shown now */
  show(open) {
    this.open = open;
    if (open) this.hooks.show();
    if (open && this.store.now.etag !== this.etag) void this.load();
    if (open) this.redraw();
  }

  layOut() {
    return this.store.edit([{ kind: "scene.arrange" }], "Panels, hooks and frames are laid out anew from the seams.");
  }

  async load() {
    const { etag } = this.store.now;
    this.etag = etag;
    part("assembly-said").textContent = "Putting the panels together…";
    /** @type {Assembly} */
    let answer;
    try {
      answer = await ask("/api/assembly");
    } catch (problem) {
      this.etag = "";
      part("assembly-said").textContent = problem instanceof Refusal ? problem.message : "The studio's server does not answer.";
      return;
    }
    if (this.store.now.etag !== etag) {
      void this.load();
      return;
    }
    this.take(answer);
  }

  /** @param {Assembly} assembly */
  take(assembly) {
    const before = this.assembly === null ? null : this.whole;
    this.assembly = assembly;
    const { stage } = this;
    part("assembly-said").textContent = assembly.seconds === undefined ? "" : `Put together and checked in ${assembly.seconds.toFixed(1)} s.`;
    if (stage) {
      const bodies = assembly.panels.map(({ name, positions_mm: places, triangles }, k) => (
        stage.bodyOf(name, places, triangles, panelTint(k))));
      if (assembly.foam) bodies.push(stage.bodyOf("", assembly.foam.positions_mm, assembly.foam.triangles, FOAM));
      stage.setBodies(bodies);
      stage.setLines(linesOf(assembly, null));
      this.whole = stage.measure();
    }
    // The view stays, unless what is seen has become much larger, smaller, or lies elsewhere.
    const apart = before ? Math.hypot(...before.middle.map((x, i) => x - this.whole.middle[i])) / before.reach : 1;
    const larger = before ? this.whole.reach / before.reach : 2;
    if (apart > 0.3 || larger > 1.3 || larger < 0.77) this.look(before ? this.camera.state : VIEWS[0]);
    this.mover.keep();
    this.lists();
    this.redraw();
  }

  /** @param {{azimuth: number, elevation: number}} view */
  look({ azimuth, elevation }) {
    const { middle, reach } = this.whole;
    Object.assign(this.camera.state, {
      target: [...middle], azimuth, elevation, distance: 0.8 * reach / Math.tan(FOV * Math.PI / 360),
    });
    this.camera.farthest = 5 * this.camera.state.distance;
    this.redraw();
  }

  lists() {
    const { faults, ties } = /** @type {Assembly} */ (this.assembly);
    part("faults-head").textContent = faults.length ? `What cannot be (${faults.length})` : "Nothing speaks against it";
    put(part("fault-list"), ...faults.map((fault, k) => make("li", {},
      make("button", { type: "button", class: "row fault", "data-key": `fault ${k}`, click: () => this.fly(fault) },
        make("span", { class: "number bad" }, String(k + 1)),
        make("span", {}, fault.text,
          fault.file ? make("span", { class: "hint" }, ` ${fault.file}${fault.line ? `, line ${fault.line}` : ""}`) : null)))));
    put(part("tie-list"), ...ties.map((tie) => make("li", {}, this.tieRow(tie))));
  }

  /** @param {import("./content.js").Tie} tie */
  tieRow(tie) {
    const { kind, name, number, target, gap_mm: gap } = tie;
    const words = [kind === "seam" ? "" : `${kind} to ${target}`, `${gap.toFixed(0)} mm apart`].filter(Boolean).join(", ");
    const hooking = this.hooks.wire !== null && kind === "seam";
    return make("button", {
      type: "button", class: "row", "data-key": `tie ${kind} ${name}`,
      "aria-pressed": String(hooking ? this.hooks.chain.includes(name) : this.chosen === name),
      click: () => this.press(hooking, name),
    }, make("span", { class: `number ${lookOf(tie)}` }, String(number)), make("span", { class: "name" }, name),
    make("span", { class: "figures" }, words));
  }

  /** @param {boolean} hooking whether seams are chosen for a wire @param {string} name of a seam */
  press(hooking, name) {
    if (!hooking) {
      this.choose(name);
      return;
    }
    this.hooks.toggle(name);
    this.lists();
  }

  /** @param {string} name of a seam */
  choose(name) {
    this.chosen = this.chosen === name ? null : name;
    if (this.assembly && this.stage) this.stage.setLines(linesOf(this.assembly, this.chosen));
    this.lists();
    this.redraw();
  }

  /** Look at a fault from the side of the seat on which it is. @param {Fault} fault */
  fly(fault) {
    const places = placesOf(fault);
    if (places.length === 0) return;
    const middle = [0, 1, 2].map((i) => places.reduce((sum, place) => sum + place[i], 0) / places.length);
    const wide = Math.max(0.08, ...places.map((place) => 2 * Math.hypot(...place.map((x, i) => x - middle[i]))));
    const out = middle.map((x, i) => x - this.whole.middle[i]);
    this.camera.flyTo(middle, Math.hypot(...out) > 0.02 ? [out[0], out[1], Math.abs(out[2]) + 0.1] : [0, -1, 0.6], 1.2 * wide);
    this.redraw();
  }

  redraw() {
    if (!this.open || !this.stage) return;
    cancelAnimationFrame(this.asked);
    this.asked = requestAnimationFrame(() => this.frame());
  }

  frame() {
    const { canvas, stage } = this;
    if (!stage) return;
    const times = window.devicePixelRatio;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.max(1, Math.round(x * times)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    const paper = this.light.matches ? [0.90, 0.90, 0.90] : [0.17, 0.17, 0.17];
    stage.draw(this.camera, this.whole, paper);
    this.drawMarks();
    this.canvas.dataset.drawn = this.etag;
  }

  /** Place in the picture [px] of a place of the world, or nothing behind the eye. @param {ArrayLike<number>} place */
  project(place) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const m = this.camera.matrix(width / height, 1.6 * this.whole.reach, this.whole.middle);
    const clip = [0, 1, 3].map((r) => m[r] * place[0] + m[4 + r] * place[1] + m[8 + r] * place[2] + m[12 + r]);
    if (clip[2] <= 0) return null;
    return [width * (0.5 + 0.5 * clip[0] / clip[2]), height * (0.5 - 0.5 * clip[1] / clip[2])];
  }

  drawMarks() {
    const { assembly, marks } = this;
    marks.setAttribute("viewBox", `0 0 ${this.canvas.clientWidth} ${this.canvas.clientHeight}`);
    if (!assembly) return;
    const out = [];
    for (const tie of assembly.ties) {
      const middle = middleOfTie(tie), at = middle && this.project(middle);
      if (at) out.push(badge(at, String(tie.number), lookOf(tie), 9));
    }
    assembly.faults.forEach((fault, k) => {
      for (const place of placesOf(fault)) {
        const at = this.project(place);
        if (!at) continue;
        out.push(draw("circle", { cx: at[0].toFixed(1), cy: at[1].toFixed(1), r: 17, class: "fault-ring" }));
        out.push(badge([at[0] + 16, at[1] - 16], String(k + 1), "bad", 9));
      }
    });
    marks.replaceChildren(...out);
  }

  /** @param {number} x @param {number} y from -1 to 1 */
  pick(x, y) {
    const hit = this.hit(x, y);
    this.mover.choose(hit?.body.name || null);
  }

  /** @param {number} x @param {number} y */
  hit(x, y) {
    const ray = this.camera.ray(x, y, this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1));
    return this.stage?.hit(this.camera.position, ray) ?? null;
  }
}

/** @param {import("./content.js").Tie} tie */
const lookOf = (tie) => (tie.kind === "seam" ? `tint-${tintNumber(tie)}` : "plain-tint");

/** @param {number[]} at @param {string} text @param {string} look @param {number} radius */
function badge(at, text, look, radius) {
  return draw("g", { class: `mark ${look}` },
    draw("circle", { cx: at[0].toFixed(1), cy: at[1].toFixed(1), r: radius }),
    draw("text", { x: at[0].toFixed(1), y: (at[1] + 4).toFixed(1) }, text));
}
