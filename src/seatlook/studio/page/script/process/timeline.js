// Stages as bars on a line of time: the ends and the whole bar are dragged, or moved by arrow keys.

import { draw } from "../dom.js";

/** @typedef {import("../types.js").Stage} Stage */
/** @typedef {"start" | "end" | "both"} Grip */
/** @typedef {{index: number, start_s: number, end_s: number}} Span */

const STAGE_ROW = 46, TOP = 26, LEFT = 120, RIGHT = 24, BAR = 30;  // px
const GRID = 0.01, CLOSE = 6, SHORTEST = 0.02;
const TIME_STEP = 0.02, TIME_LEAP = 0.1;

/** @param {number} seconds */
export const rounded = (seconds) => Math.round(seconds / GRID) * GRID;

export class TimeLine {
  /**
   * @param {SVGSVGElement} svg
   * @param {{moved: (span: Span) => void, chosen: (index: number) => void}} tell
   */
  constructor(svg, tell) {
    this.svg = svg;
    this.tell = tell;
    /** @type {Stage[]} */
    this.stages = [];
    this.active = -1;
    /** @type {Span | null} */
    this.draft = null;
    /** @type {{grip: Grip, index: number, x: number, from: Span} | null} */
    this.held = null;
    this.wait = 0;
    svg.addEventListener("pointermove", (event) => this.drag(event));
    svg.addEventListener("pointerup", () => this.drop());
    svg.addEventListener("pointercancel", () => this.drop());
    new ResizeObserver(() => this.draw()).observe(/** @type {Element} */ (svg.parentElement));
  }

  /** @param {Stage[]} stages @param {number} active */
  show(stages, active) {
    this.stages = stages;
    this.active = active;
    if (this.held === null && !this.wait) this.draft = null;
    this.draw();
  }

  get width() {
    return Math.max(this.svg.parentElement?.clientWidth ?? 0, 320);
  }

  get left() {
    return Math.min(LEFT, 0.28 * this.width);
  }

  get longest() {
    return 1.12 * Math.max(0.1, ...this.stages.map(({ end_s: end }) => end));
  }

  /** @param {number} seconds */
  x(seconds) {
    return this.left + (this.width - this.left - RIGHT) * seconds / this.longest;
  }

  /** @param {number} index @returns {Span} */
  span(index) {
    if (this.draft?.index === index) return this.draft;
    const { start_s, end_s } = this.stages[index];
    return { index, start_s, end_s };
  }

  draw() {
    const { svg, width } = this;
    const focus = document.activeElement?.getAttribute("data-grip");
    const height = TOP + STAGE_ROW * this.stages.length + 8;
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", String(height));
    svg.setAttribute("width", String(width));
    svg.replaceChildren(...this.ticks(height), ...this.stages.map((stage, k) => this.bar(stage, k)));
    if (focus) {
      const again = svg.querySelector(`[data-grip="${focus}"]`);
      if (again instanceof SVGElement) again.focus({ preventScroll: true });
    }
  }

  /** @param {number} height */
  ticks(height) {
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10].find((s) => this.longest / s <= 14) ?? 20;
    const out = [];
    for (let t = 0; t <= this.longest + 1e-9; t += step) {
      const x = this.x(t).toFixed(1);
      out.push(draw("line", { x1: x, x2: x, y1: TOP - 6, y2: height, class: "tick" }));
      out.push(draw("text", { x, y: 14, class: "tick-text" }, `${Number(t.toFixed(3))} s`));
    }
    return out;
  }

  /** @param {Stage} stage @param {number} index */
  bar(stage, index) {
    const { start_s: start, end_s: end } = this.span(index);
    const y = TOP + STAGE_ROW * index + (STAGE_ROW - BAR) / 2, x = this.x(start), wide = Math.max(this.x(end) - x, 2);
    const ramp = stage.ramp === "smooth"
      ? `M${x} ${y + BAR}C${x + wide / 2} ${y + BAR} ${x + wide / 2} ${y} ${x + wide} ${y}V${y + BAR}Z`
      : `M${x} ${y + BAR}L${x + wide} ${y}V${y + BAR}Z`;
    const name = stage.name.length > 15 ? `${stage.name.slice(0, 14)}…` : stage.name;
    return draw("g", { class: index === this.active ? "stage active" : "stage" },
      draw("text", { x: this.left - 10, y: y + BAR / 2 + 5, class: "stage-name", click: () => this.tell.chosen(index) }, name),
      draw("rect", { x, y, width: wide, height: BAR, rx: 4, class: "bar", ...this.grip("both", stage, index) }),
      draw("path", { d: ramp, class: "ramp" }),
      draw("rect", { x: x - 5, y: y - 3, width: 10, height: BAR + 6, rx: 3, class: "grip", ...this.grip("start", stage, index) }),
      draw("rect", { x: x + wide - 5, y: y - 3, width: 10, height: BAR + 6, rx: 3, class: "grip", ...this.grip("end", stage, index) }));
  }

  /** @param {Grip} grip @param {Stage} stage @param {number} index */
  grip(grip, stage, index) {
    const { start_s: start, end_s: end } = this.span(index);
    const value = grip === "end" ? end : start;
    const what = grip === "both" ? `${stage.name}, whole stage` : `${grip} of ${stage.name}`;
    return {
      tabindex: 0, role: "slider", "aria-label": what, "aria-valuemin": 0, "aria-valuemax": Number(this.longest.toFixed(2)),
      "aria-valuenow": Number(value.toFixed(3)), "aria-valuetext": `${value.toFixed(2)} s`, "data-grip": `${grip} ${index}`,
      pointerdown: (/** @type {PointerEvent} */ event) => this.take(event, grip, index),
      keydown: (/** @type {KeyboardEvent} */ event) => this.key(event, grip, index),
      focus: () => { if (index !== this.active) this.tell.chosen(index); },
    };
  }

  /** @param {PointerEvent} event @param {Grip} grip @param {number} index */
  take(event, grip, index) {
    if (event.button !== 0) return;
    this.held = { grip, index, x: event.clientX, from: this.span(index) };
    this.svg.setPointerCapture(event.pointerId);
    event.preventDefault();
    const focus = /** @type {SVGElement} */ (event.currentTarget);
    focus.focus({ preventScroll: true });
  }

  /** @param {PointerEvent} event */
  drag(event) {
    if (!this.held) return;
    const { grip, index, x, from } = this.held;
    const seconds = (event.clientX - x) * this.longest / (this.width - this.left - RIGHT);
    this.draft = this.moved(from, grip, seconds, index);
    this.draw();
  }

  drop() {
    if (!this.held) return;
    this.held = null;
    if (this.draft) this.tell.moved(this.draft);
  }

  /**
   * A span with an end, or both, moved; an end goes to that of another stage where they are close.
   * @param {Span} from
   * @param {Grip} grip
   * @param {number} by
   * @param {number} index
   * @returns {Span}
   */
  moved(from, grip, by, index) {
    const others = this.stages.flatMap(({ start_s, end_s }, k) => (k === index ? [] : [start_s, end_s]));
    const near = CLOSE * this.longest / this.width;
    const close = (/** @type {number} */ t) => others.find((other) => Math.abs(other - t) < near) ?? rounded(t);
    let { start_s: start, end_s: end } = from;
    if (grip === "start") start = Math.min(Math.max(0, close(start + by)), end - SHORTEST);
    else if (grip === "end") end = Math.max(close(end + by), start + SHORTEST);
    else [start, end] = [Math.max(0, close(start + by)), Math.max(0, close(start + by)) + end - start];
    return { index, start_s: Number(start.toFixed(4)), end_s: Number(end.toFixed(4)) };
  }

  /** @param {KeyboardEvent} event @param {Grip} grip @param {number} index */
  key(event, grip, index) {
    const way = { ArrowLeft: -1, ArrowRight: 1, ArrowDown: -1, ArrowUp: 1 }[event.key];
    if (!way || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const { start_s: start, end_s: end } = this.span(index), by = way * (event.shiftKey ? TIME_LEAP : TIME_STEP);
    const next = { index, start_s: start, end_s: end };
    if (grip !== "end") next.start_s = rounded(Math.max(0, start + by));
    if (grip === "end") next.end_s = rounded(end + by);
    if (grip === "both") next.end_s = rounded(end + next.start_s - start);
    if (next.end_s - next.start_s < SHORTEST) return;
    this.draft = { index, start_s: Number(next.start_s.toFixed(4)), end_s: Number(next.end_s.toFixed(4)) };
    this.draw();
    // Keys that follow one another are one change.
    clearTimeout(this.wait);
    this.wait = setTimeout(() => {
      this.wait = 0;
      if (this.draft) this.tell.moved(this.draft);
    }, 350);
  }
}
