// The outline of a panel as a closed line, with the corners that a pick is drawn to.

/** @typedef {import("../types.js").Panel} Panel */
/** @typedef {import("../types.js").Place} Place */
/** @typedef {{arc: number, place: Place}} Stop a corner, where an edge can end */

const APART = 0.5;  // mm within which two stops are one

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
export const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** @param {Place[]} points */
export function lengthOf(points) {
  let sum = 0;
  for (let k = 1; k < points.length; ++k) sum += apart(points[k - 1], points[k]);
  return sum;
}

/**
 * Place halfway along a line.
 * @param {Place[]} points
 * @param {number} [share]
 * @returns {Place}
 */
export function middleOf(points, share = 0.5) {
  let left = share * lengthOf(points);
  for (let k = 1; k < points.length; ++k) {
    const step = apart(points[k - 1], points[k]);
    if (left <= step && step > 0) return between(points[k - 1], points[k], left / step);
    left -= step;
  }
  return points[points.length - 1];
}

/** @param {Place} a @param {Place} b @param {number} t @returns {Place} */
const between = (a, b, t) => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];

export class Ring {
  /** @param {Panel} panel */
  constructor(panel) {
    this.panel = panel;
    const points = panel.outline_mm;
    const closed = points.length > 1 && apart(points[0], points[points.length - 1]) < 1e-6;
    this.points = closed ? points.slice(0, -1) : points;
    /** @type {number[]} */
    this.arcs = [0];
    for (let k = 0; k < this.points.length; ++k) {
      this.arcs.push(this.arcs[k] + apart(this.points[k], this.points[(k + 1) % this.points.length]));
    }
    this.length = this.arcs[this.arcs.length - 1];
    this.stops = this.stopsOf();
  }

  stopsOf() {
    /** @type {Stop[]} */
    const all = [];
    const ends = this.panel.edges.flatMap(({ points_mm: points }) => [points[0], points[points.length - 1]]);
    for (const place of [...this.panel.corners_mm, ...ends]) {
      all.push({ arc: this.nearest(place).arc, place });
    }
    all.sort((a, b) => a.arc - b.arc);
    const kept = all.filter((stop, k) => k === 0 || apart(stop.place, all[k - 1].place) > APART);
    if (kept.length > 1 && apart(kept[0].place, kept[kept.length - 1].place) <= APART) kept.pop();
    return kept;
  }

  /** @param {number} arc */
  wrapped(arc) {
    return ((arc % this.length) + this.length) % this.length;
  }

  /** @param {number} arc @returns {Place} */
  at(arc) {
    const along = this.wrapped(arc);
    let k = 1;
    while (k < this.arcs.length - 1 && this.arcs[k] < along) ++k;
    const step = this.arcs[k] - this.arcs[k - 1];
    return between(this.points[k - 1], this.points[k % this.points.length], step > 0 ? (along - this.arcs[k - 1]) / step : 0);
  }

  /** @param {ArrayLike<number>} place */
  nearest(place) {
    let best = { arc: 0, away: Infinity };
    for (let k = 0; k < this.points.length; ++k) {
      const a = this.points[k], b = this.points[(k + 1) % this.points.length];
      const [x, y] = [b[0] - a[0], b[1] - a[1]];
      const square = x * x + y * y;
      const t = square > 0 ? Math.min(1, Math.max(0, ((place[0] - a[0]) * x + (place[1] - a[1]) * y) / square)) : 0;
      const away = apart(between(a, b, t), place);
      if (away < best.away) best = { arc: this.arcs[k] + t * Math.sqrt(square), away };
    }
    return best;
  }

  /** Arc of the nearest stop within a distance, else the arc itself. @param {number} arc @param {number} within */
  snapped(arc, within) {
    let [best, away] = [arc, within];
    for (const stop of this.stops) {
      const ahead = this.wrapped(stop.arc - arc);
      const gap = Math.min(ahead, this.length - ahead);
      if (gap < away) [best, away] = [stop.arc, gap];
    }
    return best;
  }

  /**
   * Points from one arc to another, along the outline or against it.
   * @param {number} from
   * @param {number} way signed length
   * @returns {Place[]}
   */
  stretch(from, way) {
    const sign = Math.sign(way) || 1;
    const inner = this.arcs.slice(0, -1)
      .map((arc) => this.wrapped(sign * (arc - from)))
      .filter((gone) => gone > 1e-9 && gone < Math.abs(way) - 1e-9)
      .sort((a, b) => a - b);
    return [0, ...inner, Math.abs(way)].map((gone) => this.at(from + sign * gone));
  }

  /** Edge in which an arc lies, the one that begins there at a corner. @param {number} arc */
  edgeAt(arc) {
    const here = this.at(arc + 1e-3);
    let best = null, away = Infinity;
    for (const edge of this.panel.edges) {
      for (let k = 1; k < edge.points_mm.length; ++k) {
        const d = awayFrom(here, edge.points_mm[k - 1], edge.points_mm[k]);
        if (d < away) [best, away] = [edge, d];
      }
    }
    return best;
  }
}

/** @param {Place} p @param {Place} a @param {Place} b */
function awayFrom(p, a, b) {
  const [x, y] = [b[0] - a[0], b[1] - a[1]];
  const square = x * x + y * y;
  const t = square > 0 ? Math.min(1, Math.max(0, ((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square)) : 0;
  return apart(between(a, b, t), p);
}
