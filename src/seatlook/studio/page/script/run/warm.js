// What another length of an edge would do, answered from the last balance.

import { choiceField, make, numberField, part, press, put } from "../dom.js";
import { Refusal, tell } from "../api.js";
import { CoverMap } from "./map.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("../types.js").Run} Run */
/** @typedef {import("./map.js").Answer & {status: string, w2_mean: [number, number], vertices: number, seconds: number}} Warm */

const MOST_LONGER = 30;  // mm

/** The last run with a balance to start from. @param {Run[]} runs */
const lastResult = (runs) => runs.find(({ status, files }) => status === "done" && files?.some((file) => file.endsWith("/result.npz")));

export class WarmTry {
  /** @param {Store} store */
  constructor(store) {
    this.store = store;
    this.map = new CoverMap();
    this.edge = "";
    this.amount = 2;
    this.busy = false;
    /** @type {Run[]} */
    this.runs = [];
  }

  /** @param {Run[]} runs */
  show(runs) {
    this.runs = runs;
    const start = lastResult(runs);
    const edges = this.store.now.seams.flatMap(({ number, first, second }) => (
      [...first.edges, ...second.edges].map((value) => ({ value, text: `${value} (seam ${number})` }))));
    if (!start || edges.length === 0) {
      put(part("warm-form"), make("p", {}, "Evaluate first."));
      return;
    }
    if (!edges.some(({ value }) => value === this.edge)) this.edge = edges[0].value;
    put(part("warm-form"), make("div", { class: "fields" },
      choiceField("Edge", this.edge, edges, (edge) => { this.edge = edge; }, { id: "warm-edge", "data-key": "warm edge" }),
      numberField("Longer by, mm", this.amount, (amount) => { this.amount = amount; },
        { min: -MOST_LONGER, max: MOST_LONGER, id: "warm-amount", "data-key": "warm amount" }),
      press("Show it", () => void this.ask(start.name), { id: "warm-ask", "data-key": "warm ask", disabled: this.busy })));
  }

  /** @param {string} run to start from */
  async ask(run) {
    const { edge, amount } = this, begun = performance.now();
    this.busy = true;
    this.show(this.runs);
    this.say("Finding the balance…");
    try {
      /** @type {Warm} */
      const answer = await tell("/api/warm", { edge, amount_mm: amount, run });
      this.map.take(answer);
      this.say(warmWords(answer, edge, amount, (performance.now() - begun) / 1e3));
    } catch (problem) {
      this.say(problem instanceof Refusal || problem instanceof Error ? problem.message : "The studio's server does not answer.", true);
    }
    this.busy = false;
    this.show(this.runs);
  }

  /** @param {string} text @param {boolean} [bad] */
  say(text, bad = false) {
    part("warm-words").textContent = text;
    part("warm-words").classList.toggle("bad-text", bad);
  }
}

/** @param {Warm} answer @param {string} edge @param {number} amount [mm] @param {number} seconds */
function warmWords({ w2_mean: [before, after], vertices }, edge, amount, seconds) {
  const change = before > 0 ? ` (${(100 * (after / before - 1)).toFixed(1)} %)` : "";
  return `Warm: ${edge} ${Math.abs(amount)} mm ${amount < 0 ? "shorter" : "longer"}. `
    + `Mean W2 ${before.toPrecision(3)} before, ${after.toPrecision(3)} now${change}. ${vertices} vertices, ${seconds.toFixed(1)} s.`;
}
