// Running what is set up: progress with the time left, cancelled if wanted, results opened.

import { find, make, part, put } from "../dom.js";
import { Refusal, tell } from "../api.js";
import { Variants } from "./variants.js";
import { WarmTry } from "./warm.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("../types.js").Run} Run */

/** @type {Record<string, string>} */
const ENDS = {
  done: "Done.", cancelled: "Cancelled. What it had done is kept.", failed: "It did not work.", interrupted: "The studio ended first.",
};

/** @param {number} seconds */
function timeWords(seconds) {
  if (seconds < 90) return `${Math.max(1, Math.round(seconds))} s left of this`;
  return `about ${Math.round(seconds / 60)} min left of this`;
}

export class RunRoom {
  /** @param {Store} store @param {() => void} filesChanged */
  constructor(store, filesChanged) {
    this.store = store;
    /** @type {Map<string, Run>} news of runs since the state was read */
    this.news = new Map();
    part("run-evaluate").addEventListener("click", () => void this.send("/api/run", {
      command: "evaluate", score: find("run-score", HTMLInputElement).checked,
    }, "Starting…"));
    part("run-improve").addEventListener("click", () => void this.send("/api/run", { command: "improve" }, "Starting…"));
    this.variants = new Variants(store, (other) => void this.send("/api/run", { command: "compare", others: [other] }, "Starting…"));
    this.warm = new WarmTry(store);
    part("run-cancel").addEventListener("click", () => void this.send("/api/run/cancel", {}, "Stopping…"));
    const events = new EventSource("/api/events");
    events.addEventListener("run", (event) => this.hear(JSON.parse(event.data)));
    events.addEventListener("files", () => filesChanged());
  }

  get runs() {
    const known = new Set(this.store.now.runs.map(({ name }) => name));
    const fresh = [...this.news.values()].filter(({ name }) => !known.has(name)).reverse();
    return [...fresh, ...this.store.now.runs.map((run) => this.news.get(run.name) ?? run)];
  }

  show() {
    const { runs } = this, [last] = runs;
    const going = runs.find(({ status }) => status === "running");
    for (const id of ["run-evaluate", "run-improve"]) {
      find(id, HTMLButtonElement).disabled = !this.store.now.has_scene || Boolean(going);
    }
    part("run-more").hidden = !this.store.now.has_scene;
    this.variants.show(Boolean(going));
    this.warm.show(runs);
    part("run-cancel").hidden = !going;
    const bar = find("run-bar", HTMLProgressElement);
    bar.hidden = !going;
    if (going && going.fraction !== null) bar.value = going.fraction;
    else bar.removeAttribute("value");
    part("run-words").textContent = going ? progressWords(going) : last && this.news.has(last.name) ? endWords(last) : "";
    put(part("run-result"), !going && last?.page_url && this.news.has(last.name)
      && make("a", { href: last.page_url, target: "_blank", rel: "noopener", class: "main", id: "run-open" }, "Open the result"));
    put(part("run-list"), ...runs.map(runRow));
    part("run-none").hidden = runs.length > 0;
  }

  /** @param {string} path @param {Record<string, unknown>} body @param {string} words */
  async send(path, body, words) {
    part("run-words").textContent = words;
    try {
      await tell(path, body);
    } catch (problem) {
      part("run-words").textContent = "";
      this.store.voice.say(problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
    }
  }

  /** @param {Run} run */
  hear(run) {
    this.news.set(run.name, run);
    if (this.store.state) this.show();
  }
}

/** @param {Run} run */
function progressWords({ stage, fraction, seconds_left: left, figures }) {
  const { residual } = figures;
  return [
    stage || "Working", fraction === null ? "" : `${Math.round(100 * fraction)} %`, left === null ? "" : timeWords(left),
    typeof residual === "number" ? `out of balance ${residual.toExponential(1)}, wanted 1.0e-3` : "",
  ].filter(Boolean).join(", ");
}

/** @param {Run} run */
function endWords({ status, found, reason, errors, missed }) {
  return [
    ENDS[status] ?? status, found ? `The cover is ${found}${reason ? `: ${reason}` : ""}.` : "", ...errors,
    missed.length ? `Limits missed: ${missed.join("; ")}.` : "",
  ].filter(Boolean).join(" ");
}

/** @param {Run} run */
function runRow(run) {
  const { name, status, page_url: page, command } = run;
  const drawing = run.files?.find((file) => file.endsWith("/changes.png"));
  return make("li", { class: "run" },
    make("span", { class: "name" }, command && command !== "evaluate" ? `${name}, ${command}` : name),
    make("span", { class: "figures" }, status === "running" ? "running" : endWords(run)),
    page ? make("a", { href: page, target: "_blank", rel: "noopener", "data-key": `run ${name}` }, "Open the page") : null,
    status === "done" && drawing ? make("img", { src: encodeURI(drawing), alt: "Corrections drawn on the pattern" }) : null);
}
