// A cover in balance, its faces coloured by a measure, turned by mouse and keys.

import { Camera } from "../../../../report/viewer/script/drawing/camera.js";
import { Pointer } from "../../../../report/viewer/script/pointer.js";
import { draw, find, make, part, put } from "../dom.js";
import { Stage } from "../assembly/stage.js";

/** @typedef {{positions_mm: number[], triangles: number[], w2: number[]}} Answer */

// From dark to bright, told apart by people who see no red or no green.
const MAP_STEPS = [
  [68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 142], [31, 161, 135], [74, 194, 109], [159, 218, 58], [253, 231, 37],
];
const MAP_FOV = 28, MOST_FACES = 0.98;  // share of the faces that the colours tell apart

/** Value that most faces stay below. @param {number[]} values */
function topOf(values) {
  const sorted = [...values].sort((a, b) => a - b);
  return Math.max(sorted[Math.floor(MOST_FACES * (sorted.length - 1))] ?? 0, 1e-6);
}

export class CoverMap {
  constructor() {
    this.canvas = find("warm-canvas", HTMLCanvasElement);
    this.camera = new Camera({ name: "front", position: [0.8, -1.2, 0.8], target: [0, 0, 0], up: [0, 0, 1], fov: MAP_FOV, size: [16, 10] });
    this.whole = { middle: [0, 0, 0], reach: 0 };
    this.light = matchMedia("(prefers-color-scheme: light)");
    this.light.addEventListener("change", () => this.redraw());
    /** @type {Stage | null} */
    this.stage = null;
    new Pointer(this.canvas, this.camera, () => this.redraw(), () => {});
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
  }

  /** @param {Answer} answer */
  take({ positions_mm: places, triangles, w2 }) {
    part("warm-map").hidden = false;
    this.stage ??= new Stage(this.canvas);
    const { stage } = this, top = topOf(w2);
    /** @type {number[][]} */
    const faces = MAP_STEPS.map(() => []);
    w2.forEach((value, k) => {
      const step = Math.min(MAP_STEPS.length - 1, Math.max(0, Math.floor(MAP_STEPS.length * value / top)));
      faces[step].push(...triangles.slice(3 * k, 3 * k + 3));
    });
    stage.setBodies(MAP_STEPS.map((colour, k) => stage.bodyOf("", places, faces[k], colour.map((x) => x / 255))));
    const first = this.whole.reach === 0;
    this.whole = stage.measure();
    if (first) {
      Object.assign(this.camera.state, {
        target: [...this.whole.middle], azimuth: 0.55, elevation: 0.6, distance: 0.8 * this.whole.reach / Math.tan(MAP_FOV * Math.PI / 360),
      });
      this.camera.farthest = 5 * this.camera.state.distance;
    }
    put(part("warm-legend"), legendOf(top));
    this.redraw();
  }

  redraw() {
    const { canvas, stage } = this;
    if (!stage || !canvas.clientWidth) return;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((x) => Math.max(1, Math.round(x * window.devicePixelRatio)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    stage.draw(this.camera, this.whole, this.light.matches ? [0.90, 0.90, 0.90] : [0.17, 0.17, 0.17]);
  }
}

/** Colours and what they stand for. @param {number} top */
function legendOf(top) {
  const wide = 22;
  return make("span", { class: "acts" }, "W2: 0",
    draw("svg", { width: wide * MAP_STEPS.length, height: 16, "aria-hidden": "true" }, ...MAP_STEPS.map((colour, k) => (
      draw("rect", { x: wide * k, width: wide, height: 16, fill: `rgb(${colour.join(",")})` })))),
    `${top.toPrecision(2)} and more`);
}
