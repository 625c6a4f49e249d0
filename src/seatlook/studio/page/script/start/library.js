// The library beside the folder: what it holds, found by words, and taken into the folder.

import { make, part, press, put } from "../dom.js";
import { ask, Refusal, tell } from "../api.js";

/** @typedef {{name: string, label: string, kind: string, place: string, words: string[], note: string, thumbnail: string | null}} Entry */

const UNUSABLE = ["result"];

export class LibraryShelf {
  /** @param {(state: any, entry: Entry) => void} taken */
  constructor(taken) {
    this.taken = taken;
    /** @type {Entry[]} */
    this.entries = [];
    this.words = "";
    void this.look();
  }

  async look() {
    const { library, entries, errors } = await ask("/api/library");
    part("start-library-box").hidden = library === null;
    this.entries = entries;
    const search = make("input", { type: "search", id: "library-words" });
    search.addEventListener("input", () => {
      this.words = search.value;
      this.list();
    });
    put(part("start-library"), make("label", { class: "field" }, make("span", {}, "Find"), search),
      make("ul", { id: "library-entries", class: "cards" }), make("div", { id: "seen-library", "aria-live": "polite" }));
    this.list();
    if (errors.length) this.say(errors.map((/** @type {{text: string}} */ { text }) => text).join(" "), true);
  }

  list() {
    const sought = this.words.toLowerCase().split(/\s+/).filter(Boolean);
    const found = this.entries.filter((one) => {
      const text = [one.label, one.kind, one.place, one.note, ...one.words].join(" ").toLowerCase();
      return sought.every((word) => text.includes(word));
    });
    put(part("library-entries"), ...found.map((one) => make("li", { class: "card" },
      one.thumbnail && make("img", { src: one.thumbnail, alt: "", width: 96, height: 96 }),
      make("strong", {}, one.label), make("span", { class: "hint" }, [one.kind, ...one.words].join(", ")),
      !UNUSABLE.includes(one.kind) && press(`Take ${one.label}`, () => void this.take(one), { "data-key": `library ${one.place}` }))));
  }

  /** @param {Entry} entry */
  async take(entry) {
    this.say(`Taking ${entry.label}…`);
    try {
      const state = await tell("/api/library/use", { place: entry.place, force: part("start-force").matches(":checked") });
      this.say(state.files_to_start ? `${entry.label} stands for a file above.` : `${entry.label} is in the folder.`);
      this.taken(state, entry);
    } catch (problem) {
      this.say(problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
    }
  }

  /** @param {string} text @param {boolean} [bad] */
  say(text, bad = false) {
    put(part("seen-library"), make("p", { class: bad ? "bad-text" : "hint" }, text));
  }
}
