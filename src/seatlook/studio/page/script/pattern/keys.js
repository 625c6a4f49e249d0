// The pattern by keyboard: a cursor that steps from corner to corner and from panel to panel.

import { apart } from "./ring.js";

/** @typedef {import("./ring.js").Ring} Ring */
/** @typedef {import("./sheet.js").Pick} Pick */
/** @typedef {import("../types.js").Place} Place */

const WAYS = ["right", "upper right", "top", "upper left", "left", "lower left", "bottom", "lower right"];

export class Cursor {
  /** @param {() => Map<string, Ring>} rings */
  constructor(rings) {
    this.rings = rings;
    this.panel = 0;
    this.stop = 0;
  }

  get ring() {
    const all = [...this.rings().values()];
    return all[this.panel % Math.max(all.length, 1)];
  }

  /** @returns {Pick | null} */
  get pick() {
    const { ring } = this;
    if (!ring || ring.stops.length === 0) return null;
    return { panel: ring.panel.name, arc: ring.stops[this.stop % ring.stops.length].arc };
  }

  /** @param {number} step along the outline */
  along(step) {
    const count = this.ring?.stops.length ?? 1;
    this.stop = (this.stop + step + count) % count;
  }

  /** @param {number} step to another panel */
  across(step) {
    const count = Math.max(this.rings().size, 1);
    this.panel = (this.panel + step + count) % count;
    this.stop = 0;
  }

  /** Go to a pick, or the stop next to it. @param {Pick} pick */
  to(pick) {
    const names = [...this.rings().keys()];
    this.panel = Math.max(names.indexOf(pick.panel), 0);
    const { ring } = this;
    const gaps = ring.stops.map(({ arc }) => {
      const ahead = ring.wrapped(arc - pick.arc);
      return Math.min(ahead, ring.length - ahead);
    });
    this.stop = Math.max(gaps.indexOf(Math.min(...gaps)), 0);
  }

  /** Where the cursor is, in words. */
  get words() {
    const { ring, pick } = this;
    if (!ring || !pick) return "";
    const { place } = ring.stops[this.stop % ring.stops.length];
    const edge = ring.edgeAt(pick.arc);
    const begins = edge && apart(edge.points_mm[0], place) < 1 ? `${edge.name} begins here, ${edge.length_mm.toFixed(1)} mm` : "";
    return [`${ring.panel.name}, corner ${this.stop + 1} of ${ring.stops.length}, ${wayOf(ring, place)}`, begins]
      .filter(Boolean).join("; ");
  }
}

/** Where on its panel a place lies, as it is drawn. @param {Ring} ring @param {Place} place */
function wayOf(ring, place) {
  const xs = ring.points.map(([x]) => x), ys = ring.points.map(([, y]) => y);
  const x = (place[0] - (Math.min(...xs) + Math.max(...xs)) / 2) / Math.max(Math.max(...xs) - Math.min(...xs), 1);
  const y = (place[1] - (Math.min(...ys) + Math.max(...ys)) / 2) / Math.max(Math.max(...ys) - Math.min(...ys), 1);
  return WAYS[((Math.round(Math.atan2(y, x) / (Math.PI / 4)) % 8) + 8) % 8];
}

/**
 * Free lengths that fit a line best, where the keyboard's cursor goes first.
 * @param {Map<string, Ring>} rings
 * @param {Set<string>} sewn names of edges
 * @param {{panel: string, length: number, middle: Place}} line
 * @returns {Pick | null}
 */
export function likelyPartner(rings, sewn, line) {
  let best = null, worst = 0.1;
  for (const ring of rings.values()) {
    for (const edge of ring.panel.edges) {
      if (sewn.has(edge.name)) continue;
      const own = ring.panel.name === line.panel;
      if (own && apart(edge.points_mm[0], line.middle) < 0.6 * line.length) continue;
      const off = Math.abs(edge.length_mm / line.length - 1) + (own ? 0.05 : 0);
      // The partner runs against the outline: its start meets where the edge ends.
      const end = edge.points_mm[edge.points_mm.length - 1];
      if (off < worst) [best, worst] = [{ panel: ring.panel.name, arc: ring.nearest(end).arc }, off];
    }
  }
  return best;
}
