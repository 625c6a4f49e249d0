// The studio: rooms one beside the other, one of them shown; every change is in the files at once.

import { ask } from "./api.js";
import { AssemblyRoom } from "./assembly/room.js";
import { find, make, part, press, put } from "./dom.js";
import { LooksRoom } from "./looks/room.js";
import { PatternRoom } from "./pattern/room.js";
import { ProcessRoom } from "./process/room.js";
import { RunRoom } from "./run/room.js";
import { StartRoom } from "./start/room.js";
import { Store } from "./store.js";

/** @typedef {import("./types.js").State} State */
/** @typedef {import("./api.js").Refusal} Refusal */

const ROOMS = ["start", "pattern", "assembly", "process", "looks", "run"];

class Studio {
  constructor() {
    this.store = new Store({ say: (text, bad) => this.say(text, bad), conflict: (refusal, again) => this.conflict(refusal, again) });
    this.at = "start";
    this.pattern = new PatternRoom(this.store);
    this.assembly = new AssemblyRoom(this.store);
    this.process = new ProcessRoom(this.store);
    this.looks = new LooksRoom(this.store);
    this.start = new StartRoom(this.store, () => this.open("pattern"));
    this.run = new RunRoom(this.store, () => void this.filesChanged());
    this.store.listen((state) => this.show(state));
    for (const [k, name] of ROOMS.entries()) {
      const tab = part(`tab-${name}`);
      tab.addEventListener("click", () => this.open(name));
      tab.addEventListener("keydown", (event) => this.tabKey(event, k));
    }
    part("undo").addEventListener("click", () => void this.store.undo());
    part("redo").addEventListener("click", () => void this.store.redo());
    document.addEventListener("keydown", (event) => this.key(event));
  }

  async begin() {
    try {
      await this.store.load();
    } catch (problem) {
      this.say(problem instanceof Error ? problem.message : String(problem), true);
      return;
    }
    this.open(this.store.now.has_scene ? "pattern" : "start");
  }

  /** @param {string} name of a room */
  open(name) {
    this.at = name;
    for (const room of ROOMS) {
      const own = room === name;
      part(`room-${room}`).hidden = !own;
      part(`tab-${room}`).setAttribute("aria-selected", String(own));
      part(`tab-${room}`).tabIndex = own ? 0 : -1;
    }
    if (this.store.state) this.show(this.store.state);
    if (name === "looks") void this.store.loadMaterials();
  }

  /** @param {KeyboardEvent} event @param {number} k */
  tabKey(event, k) {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const next = ROOMS[(k + way + ROOMS.length) % ROOMS.length];
    this.open(next);
    part(`tab-${next}`).focus();
  }

  /** @param {State} state */
  show(state) {
    // Its own name here, the whole path for who points at it.
    part("folder").textContent = (state.folder ?? "").split(/[\\/]/).pop() ?? "";
    part("folder").title = state.folder ?? "";
    for (const way of /** @type {const} */ (["undo", "redo"])) {
      const words = state[way];
      find(way, HTMLButtonElement).disabled = !words;
      find(way, HTMLButtonElement).title = typeof words === "string" ? words : "";
    }
    put(part("errors-list"), ...state.errors.map(({ file, line, text }) => make("li", {},
      make("strong", {}, [file, line ? `line ${line}` : ""].filter(Boolean).join(", ")), ` ${text}`)));
    part("errors").hidden = state.errors.length === 0;
    const { at } = this;
    this.assembly.show(at === "assembly");
    if (at === "start") this.start.show();
    else if (at === "pattern") this.pattern.show();
    else if (at === "process") this.process.show();
    else if (at === "looks") this.looks.show();
    else if (at === "run") this.run.show();
  }

  /** @param {string} text @param {boolean} [bad] */
  say(text, bad = false) {
    const status = part("status");
    status.textContent = text;
    status.classList.toggle("bad", bad);
  }

  /** A file was changed by another program or tab. */
  async filesChanged() {
    const { etag } = await ask("/api/state");
    if (etag === this.store.state?.etag || this.store.waiting) return;
    await this.store.load();
    this.say("A file was changed outside the studio. What you see is what it holds now.");
  }

  /** @param {Refusal} refusal @param {() => void} again */
  conflict(refusal, again) {
    const dialog = find("conflict", HTMLDialogElement);
    put(part("conflict-words"), make("p", {}, refusal.message));
    put(part("conflict-acts"),
      press("Make my change in the file as it is now", () => {
        dialog.close();
        void this.store.load().then(again);
      }),
      press("Leave my change, show the file", () => {
        dialog.close();
        void this.store.load();
      }));
    dialog.showModal();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const typed = event.target instanceof HTMLInputElement && event.target.type === "text";
    if (!(event.ctrlKey || event.metaKey) || typed) return;
    const letter = event.key.toLowerCase();
    if (letter === "z" && !event.shiftKey && this.store.state?.undo) void this.store.undo();
    else if ((letter === "y" || (letter === "z" && event.shiftKey)) && this.store.state?.redo) void this.store.redo();
    else return;
    event.preventDefault();
  }
}

void new Studio().begin();
