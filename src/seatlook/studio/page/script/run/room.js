// Running what is set up: progress with the time left, cancelled if wanted, results opened.

import { find, make, part, put } from "../dom.js";
import { Refusal, tell } from "../api.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {{run: string, status: string, stage?: string, fraction?: number, seconds_left?: number | null,
 *   residual?: number | null, text?: string, page_url?: string | null}} News */

/** @param {number} seconds */
function timeWords(seconds) {
  if (seconds < 90) return `${Math.max(1, Math.round(seconds))} s left`;
  return `about ${Math.round(seconds / 60)} min left`;
}

export class RunRoom {
  /** @param {Store} store @param {() => void} filesChanged */
  constructor(store, filesChanged) {
    this.store = store;
    this.filesChanged = filesChanged;
    this.running = "";
    this.run = "";
    part("run-evaluate").addEventListener("click", () => void this.start("evaluate"));
    part("run-improve").addEventListener("click", () => void this.start("improve"));
    part("run-cancel").addEventListener("click", () => void this.cancel());
    const events = new EventSource("/api/events");
    events.addEventListener("run", (event) => this.hear(JSON.parse(event.data)));
    events.addEventListener("files", () => this.filesChanged());
  }

  show() {
    const { runs, now: { has_scene: ready } } = this.store;
    for (const id of ["run-evaluate", "run-improve"]) find(id, HTMLButtonElement).disabled = !ready || this.running !== "";
    part("run-cancel").hidden = this.running === "";
    put(part("run-list"), ...runs.map(({ run, command, path, status, page_url: page }) => make("li", {},
      make("span", { class: "name" }, path ?? command ?? run), make("span", { class: "figures" }, status),
      page ? make("a", { href: page, target: "_blank", rel: "noopener", "data-key": `run ${run}` }, "Open the page") : null)));
    part("run-none").hidden = runs.length > 0;
  }

  /** @param {string} command */
  async start(command) {
    this.running = command;
    this.show();
    put(part("run-result"));
    part("run-words").textContent = "Starting…";
    find("run-bar", HTMLProgressElement).hidden = false;
    find("run-bar", HTMLProgressElement).removeAttribute("value");
    try {
      this.run = (await tell("/api/run", { command, options: {} })).run;
    } catch (problem) {
      this.end(problem instanceof Refusal ? problem.message : "The studio's server does not answer.");
    }
  }

  async cancel() {
    part("run-words").textContent = "Stopping…";
    try {
      await tell("/api/run/cancel", { run: this.run });
    } catch (problem) {
      this.store.voice.say(problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
    }
  }

  /** @param {News} news */
  hear(news) {
    this.run = news.run;
    if (news.status === "running") {
      this.progress(news);
      return;
    }
    this.end(news.text ?? news.status);
    if (news.page_url) {
      put(part("run-result"), make("a", { href: news.page_url, target: "_blank", rel: "noopener", class: "main" }, "Open the result"));
    }
    void this.store.loadRuns();
  }

  /** @param {News} news */
  progress({ stage, fraction, seconds_left: left, residual }) {
    if (!this.running) {
      this.running = "run";
      this.show();
    }
    const bar = find("run-bar", HTMLProgressElement);
    bar.hidden = false;
    if (typeof fraction === "number") bar.value = fraction;
    part("run-words").textContent = [
      stage ? `Stage ${stage}` : "Working", typeof fraction === "number" ? `${Math.round(100 * fraction)} %` : "",
      typeof left === "number" ? timeWords(left) : "",
      typeof residual === "number" ? `out of balance ${residual.toExponential(1)}, wanted 1.0e-3` : "",
    ].filter(Boolean).join(", ");
  }

  /** @param {string} words */
  end(words) {
    this.running = "";
    find("run-bar", HTMLProgressElement).hidden = true;
    part("run-words").textContent = words;
    if (this.store.state) this.show();
  }
}

