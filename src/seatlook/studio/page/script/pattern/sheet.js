// The drawing of the pattern: panels, edges, seams with number and colour, and what is being sewn.

import { draw } from "../dom.js";
import { laidOut } from "./layout.js";
import { Ring, apart, middleOf } from "./ring.js";
import { Window } from "./window.js";

/** @typedef {import("../types.js").Panel} Panel */
/** @typedef {import("../types.js").Place} Place */
/** @typedef {import("../types.js").Seam} Seam */
/** @typedef {import("../types.js").Guess} Guess */
/** @typedef {import("../types.js").Side} Side */
/** @typedef {import("./layout.js").Shift} Shift */
/** @typedef {{panel: string, arc: number}} Pick */
/** @typedef {{panel: string, points: Place[], look: string}} Mark a line laid over an outline */

const COLOURS = 8;
const NARROW = 600;  // px of a sheet on which letters are smaller
const CORNER = 6;  // px from a corner within which a click means it
const REACH = 28;  // px from an outline within which a click picks

/** @param {number} number of a seam */
export const tintOf = (number) => `tint-${(number - 1) % COLOURS}`;

/** @param {Place[]} points */
function boxOf(points) {
  const columns = [0, 1].map((i) => points.map((place) => place[i]));
  const [low, high] = [columns.map((x) => Math.min(...x)), columns.map((x) => Math.max(...x))];
  return { middle: low.map((x, i) => (x + high[i]) / 2), size: low.map((x, i) => high[i] - x) };
}

export class Sheet {
  /**
   * @param {SVGSVGElement} svg
   * @param {{pick: (pick: Pick) => void, hover: (pick: Pick | null) => void, seam: (name: string) => void,
   *   sewing: () => boolean}} tell
   */
  constructor(svg, tell) {
    this.svg = svg;
    this.tell = tell;
    /** @type {Map<string, Ring>} */
    this.rings = new Map();
    /** @type {Map<string, Shift>} */
    this.shifts = new Map();
    /** @type {Map<string, string>} */
    this.owners = new Map();
    /** @type {Map<string, import("../types.js").Edge>} */
    this.edges = new Map();
    this.key = "";
    this.layers = {
      cloth: draw("g", { class: "cloth" }), seams: draw("g"), over: draw("g"), labels: draw("g", { class: "labels" }),
    };
    svg.append(...Object.values(this.layers));
    this.window = new Window(svg, () => this.rescale(), (event) => this.click(event));
    svg.addEventListener("pointermove", (event) => {
      if (!event.buttons) this.tell.hover(this.pickAt(event));
    });
    svg.addEventListener("pointerleave", () => this.tell.hover(null));
  }

  /** @param {Panel[]} panels */
  setPanels(panels) {
    const key = JSON.stringify(panels);
    if (key === this.key) return;
    this.edges = new Map(panels.flatMap(({ edges }) => edges.map((edge) => [edge.name, edge])));
    this.owners = new Map(panels.flatMap(({ name, edges }) => edges.map((edge) => [edge.name, name])));
    const same = this.rings.size === panels.length && panels.every(({ name }) => this.rings.has(name));
    this.key = key;
    this.rings = new Map(panels.map((panel) => [panel.name, new Ring(panel)]));
    if (!same) this.layOut(panels);
    this.layers.cloth.replaceChildren(...panels.map((panel) => this.panelOf(panel)));
  }

  /** @param {Panel[]} panels */
  layOut(panels) {
    const layout = laidOut(panels, this.window.aspect);
    this.shifts = layout.shifts;
    this.window.fit(layout.width, layout.height);
  }

  /** Lay panels out anew for the window as it is, and show all of them. */
  showAll() {
    const panels = [...this.rings.values()].map(({ panel }) => panel);
    this.layOut(panels);
    this.layers.cloth.replaceChildren(...panels.map((panel) => this.panelOf(panel)));
  }

  /** Place on the sheet. @param {string} panel @param {ArrayLike<number>} place @returns {Place} */
  on(panel, place) {
    const shift = this.shifts.get(panel) ?? { x: 0, y: 0 };
    return [place[0] + shift.x, shift.y - place[1]];
  }

  /** @param {string} panel @param {Place[]} points */
  text(panel, points) {
    return points.map((place) => this.on(panel, place).map((x) => x.toFixed(2)).join(",")).join(" ");
  }

  /** @param {string} panel @param {ArrayLike<number>} place @param {string} look */
  dot(panel, place, look) {
    const [x, y] = this.on(panel, place);
    return draw("path", { d: `M${x.toFixed(2)} ${y.toFixed(2)}h0`, class: `dot ${look}` });
  }

  /** @param {Panel} panel */
  panelOf(panel) {
    const { name } = panel;
    const ring = /** @type {Ring} */ (this.rings.get(name));
    const group = draw("g", { "data-panel": name }, draw("polygon", { points: this.text(name, ring.points), class: "panel" }));
    for (const hole of panel.holes_mm ?? []) group.append(draw("polygon", { points: this.text(name, hole), class: "hole" }));
    if (panel.cut_mm) group.append(draw("polygon", { points: this.text(name, panel.cut_mm), class: "cut" }));
    for (const line of panel.lines ?? []) {
      group.append(draw("polyline", { points: this.text(name, line.points_mm), class: "line" }));
    }
    for (const edge of panel.edges) {
      group.append(draw("polyline", { points: this.text(name, edge.points_mm), class: "edge" }));
    }
    if (panel.grain_mm) group.append(this.grain(panel, panel.grain_mm));
    for (const { place } of ring.stops) group.append(this.dot(name, place, "corner"));
    for (const { point_mm: place } of panel.edges.flatMap(({ notches }) => notches ?? [])) {
      group.append(this.notch(ring, ring.nearest(place).arc));
    }
    return group;
  }

  /** @param {Ring} ring @param {number} arc */
  notch(ring, arc) {
    const [a, b] = [ring.at(arc - 0.5), ring.at(arc + 0.5)];
    const long = Math.max(apart(a, b), 1e-9), at = ring.at(arc);
    // The outline runs counter-clockwise: inside is on its left.
    const inward = [-(b[1] - a[1]) / long, (b[0] - a[0]) / long];
    return draw("polyline", {
      points: this.text(ring.panel.name, [at, [at[0] + 9 * inward[0], at[1] + 9 * inward[1]]]), class: "notch",
    });
  }

  /** An arrow along the warp, in the middle of the panel. @param {Panel} panel @param {[Place, Place]} ends */
  grain({ name, outline_mm: points }, [a, b]) {
    const { middle, size } = boxOf(points), far = Math.max(apart(a, b), 1e-9);
    const u = [(b[0] - a[0]) / far, (b[1] - a[1]) / far];
    const half = 0.3 * (Math.abs(u[0]) * size[0] + Math.abs(u[1]) * size[1]), head = Math.min(9, 0.4 * half);
    const [from, to] = [-half, half].map((t) => /** @type {Place} */ ([middle[0] + t * u[0], middle[1] + t * u[1]]));
    /** @type {Place} */
    const left = [to[0] - head * (u[0] + 0.4 * u[1]), to[1] - head * (u[1] - 0.4 * u[0])];
    /** @type {Place} */
    const right = [to[0] - head * (u[0] - 0.4 * u[1]), to[1] - head * (u[1] + 0.4 * u[0])];
    return draw("g", {},
      draw("polyline", { points: this.text(name, [from, to]), class: "grain" }),
      draw("polyline", { points: this.text(name, [left, to, right]), class: "grain" }));
  }

  /**
   * @param {Seam[]} seams
   * @param {Guess[]} guesses
   * @param {{seam: string | null, guess: string | null, names: boolean}} chosen
   */
  setSeams(seams, guesses, chosen) {
    const { seams: lines, labels } = this.layers;
    lines.replaceChildren();
    labels.replaceChildren();
    for (const { panel } of this.rings.values()) this.nameOf(panel, chosen.names);
    guesses.forEach((guess) => {
      const look = `guess${guess.id === chosen.guess ? " lit" : ""}`;
      for (const side of [guess.first, guess.second]) this.sideOf(side, look, "?", `guess-badge${guess.id === chosen.guess ? " lit" : ""}`);
    });
    for (const seam of seams) {
      const lit = seam.name === chosen.seam ? " lit" : "";
      for (const side of [seam.first, seam.second]) {
        const badge = this.sideOf(side, `seam ${tintOf(seam.number)}${lit}`, String(seam.number), `badge ${tintOf(seam.number)}${lit}`);
        badge?.addEventListener("pointerup", (event) => {
          // A number may lie over a corner: there, and while a seam is picked, it is in the way of a pick.
          if (this.window.press?.moved || this.tell.sewing() || this.atCorner(event)) return;
          event.stopPropagation();
          this.window.press = null;
          this.tell.seam(seam.name);
        });
      }
    }
  }

  /** @param {Panel} panel @param {boolean} edges whether edges are named too */
  nameOf(panel, edges) {
    this.layers.labels.append(this.label(panel.name, boxOf(panel.outline_mm).middle, panel.name, "panel-name"));
    if (!edges) return;
    for (const edge of panel.edges) {
      const own = edge.name.startsWith(`${panel.name}.`) ? edge.name.slice(panel.name.length + 1) : edge.name;
      this.layers.labels.append(this.label(panel.name, middleOf(edge.points_mm, 0.3), `${own} ${edge.length_mm.toFixed(1)}`, "edge-name"));
    }
  }

  /** @param {string} panel @param {ArrayLike<number>} place @param {string} text @param {string} look */
  label(panel, place, text, look) {
    const [x, y] = this.on(panel, place);
    return draw("text", { x: x.toFixed(2), y: y.toFixed(2), class: look }, text);
  }

  /**
   * One side of a seam: its line, and its number halfway along.
   * @param {Side} side
   * @param {string} look
   * @param {string} text
   * @param {string} badge
   */
  sideOf(side, look, text, badge) {
    let group = null;
    for (const [k, edge] of side.edges.entries()) {
      const panel = this.panelOfEdge(edge) ?? side.panel;
      const points = side.points_mm?.[k] ?? this.edges.get(edge)?.points_mm ?? [];
      if (points.length < 2) continue;
      this.layers.seams.append(draw("polyline", { points: this.text(panel, points), class: look }));
      const middle = middleOf(points);
      group = draw("g", { class: badge }, this.dot(panel, middle, "disc"), this.label(panel, middle, text, "number"));
      this.layers.labels.append(group);
    }
    return group;
  }

  /** Panel of an edge, of one that is only guessed by its name. @param {string} edge */
  panelOfEdge(edge) {
    const owner = this.owners.get(edge);
    if (owner) return owner;
    const named = [...this.rings.keys()].filter((name) => edge?.startsWith(`${name}.`));
    return named.sort((a, b) => b.length - a.length)[0];
  }

  /** What is being sewn, laid over all else. @param {Mark[]} marks @param {{panel: string, place: Place, look: string}[]} dots */
  lay(marks, dots) {
    this.layers.over.replaceChildren(
      ...marks.map(({ panel, points, look }) => draw("polyline", { points: this.text(panel, points), class: look })),
      ...dots.map(({ panel, place, look }) => this.dot(panel, place, look)),
    );
  }

  /** Letters keep their size on the screen. */
  rescale() {
    const size = this.svg.clientWidth < NARROW ? 10 : 13;
    this.layers.labels.setAttribute("font-size", (size * this.window.pixel).toFixed(3));
  }

  /** @param {MouseEvent} event @returns {Pick | null} */
  pickAt(event) {
    const place = this.window.placeOf(event), { pixel } = this.window;
    /** @type {Pick | null} */
    let best = null;
    let away = REACH * pixel;
    for (const [panel, ring] of this.rings) {
      const shift = /** @type {Shift} */ (this.shifts.get(panel));
      const near = ring.nearest([place[0] - shift.x, shift.y - place[1]]);
      if (near.away < away) [best, away] = [{ panel, arc: near.arc }, near.away];
    }
    return best;
  }

  /** Whether a click means a corner. @param {MouseEvent} event */
  atCorner(event) {
    const pick = this.pickAt(event), ring = pick && this.rings.get(pick.panel);
    if (!pick || !ring) return false;
    return apart(ring.at(ring.snapped(pick.arc, Infinity)), ring.at(pick.arc)) < CORNER * this.window.pixel;
  }

  /** @param {PointerEvent} event */
  click(event) {
    const pick = this.pickAt(event);
    if (pick) this.tell.pick(pick);
  }
}
