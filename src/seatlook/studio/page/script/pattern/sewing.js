// Four picks sew: start and end on one line, start and direction on the other.

import { percentWords } from "./seams.js";

/** @typedef {import("./ring.js").Ring} Ring */
/** @typedef {import("./sheet.js").Pick} Pick */
/** @typedef {import("./sheet.js").Mark} Mark */

export const STEPS = [
  "Pick where the seam starts.",
  "Pick where it ends, on the same panel.",
  "Pick where the start meets its partner.",
  "Pick the direction in which the partner runs.",
];

const FIT = 0.1;  // share by which two sides may differ, as everywhere
const NEAR = 2;  // mm: two picks at one place are none

export class Sewing {
  /** @param {() => Map<string, Ring>} rings */
  constructor(rings) {
    this.rings = rings;
    /** @type {Pick[]} */
    this.picks = [];
    /** Whether the first line runs the longer way round. */
    this.around = false;
  }

  /** @param {string} panel */
  ring(panel) {
    const ring = this.rings().get(panel);
    if (!ring) throw new Error(`no panel ${panel}`);
    return ring;
  }

  get step() {
    return this.picks.length;
  }

  clear() {
    this.picks = [];
    this.around = false;
  }

  back() {
    this.picks.pop();
    if (this.step < 2) this.around = false;
  }

  /** Where a pick is taken: seams begin and end at corners, a direction is any place. @param {Pick} pick @returns {Pick} */
  settled(pick) {
    return this.step === 3 ? pick : { ...pick, arc: this.ring(pick.panel).snapped(pick.arc, Infinity) };
  }

  /** Why a pick cannot be taken now, or nothing. @param {Pick} pick */
  objection(pick) {
    const last = this.picks[this.step - 1];
    if (this.step === 1 || this.step === 3) {
      if (pick.panel !== last.panel) {
        return `This pick belongs on ${last.panel}, where the last one is. Esc begins anew.`;
      }
      const ring = this.ring(pick.panel);
      const way = ring.wrapped(pick.arc - last.arc);
      if (Math.min(way, ring.length - way) < NEAR) return "This is the same place again. Pick another one on the line.";
    }
    return "";
  }

  /** @param {Pick} pick */
  take(pick) {
    this.picks.push(pick);
  }

  /** Signed way along the outline from pick to pick. @param {Pick} from @param {Pick} to @param {boolean} around */
  way(from, to, around) {
    const ring = this.ring(from.panel);
    const ahead = ring.wrapped(to.arc - from.arc);
    return (ahead <= ring.length / 2) !== around ? ahead : ahead - ring.length;
  }

  /** The first line, as far as it is known. @param {Pick | null} cursor */
  first(cursor) {
    const [start, end] = this.picks;
    const last = end ?? (this.step === 1 && cursor && !this.objection(cursor) ? cursor : null);
    if (!start || !last) return null;
    return { panel: start.panel, from: start.arc, way: this.way(start, last, this.around) };
  }

  /** The partner as it will be; the server has the last word. @param {Pick | null} cursor */
  second(cursor) {
    const first = this.first(null), start = this.picks[2];
    const toward = this.picks[3] ?? (cursor && this.step === 3 && !this.objection(cursor) ? cursor : null);
    if (!first || !start || !toward) return null;
    const ring = this.ring(start.panel);
    const sign = Math.sign(this.way(start, toward, false));
    // As the server finds it: the corner that is as far away as the first line is long.
    const length = Math.abs(first.way);
    const ways = ring.stops.map(({ arc }) => ring.wrapped(sign * (arc - start.arc))).filter((way) => way > NEAR);
    ways.sort((a, b) => Math.abs(a - length) - Math.abs(b - length));
    return ways.length ? { panel: start.panel, from: start.arc, way: sign * ways[0] } : null;
  }

  /** How badly the partner fits the first line. @param {Pick | null} cursor */
  misfit(cursor) {
    const first = this.first(null), second = this.second(cursor);
    return first && second ? Math.abs(Math.abs(second.way) / Math.abs(first.way) - 1) : Infinity;
  }

  /** Where no partner fits the shorter way round the first panel, the longer one is meant. @param {Pick | null} cursor */
  fitWay(cursor) {
    const now = this.misfit(cursor);
    if (now <= FIT) return;
    this.around = !this.around;
    if (this.misfit(cursor) > FIT) this.around = !this.around;
  }

  /** What the server is asked. */
  question() {
    this.fitWay(null);
    const [a, b, c, d] = this.picks;
    const place = (/** @type {Pick} */ pick) => this.ring(pick.panel).at(pick.arc);
    return {
      first: {
        panel: a.panel, start: place(a), end: place(b),
        via: this.ring(a.panel).at(a.arc + this.way(a, b, this.around) / 2),
      },
      second: { panel: c.panel, start: place(c), toward: place(d) },
    };
  }

  /** @param {Pick | null} cursor @returns {Mark[]} */
  marks(cursor) {
    /** @type {Mark[]} */
    const marks = [];
    for (const [line, look] of /** @type {const} */ ([[this.first(cursor), "picked"], [this.second(cursor), "partner"]])) {
      if (line) marks.push({ panel: line.panel, points: this.ring(line.panel).stretch(line.from, line.way), look });
    }
    return marks;
  }

  /** Lengths in words as the picks stand. @param {Pick | null} cursor */
  words(cursor) {
    const first = this.first(cursor), second = this.second(cursor);
    if (!first) return "";
    const length = Math.abs(first.way);
    if (!second) return `${length.toFixed(1)} mm so far.`;
    const other = Math.abs(second.way);
    return `${length.toFixed(1)} mm to ${other.toFixed(1)} mm, ease ${percentWords(100 * (length / other - 1))}.`;
  }
}
