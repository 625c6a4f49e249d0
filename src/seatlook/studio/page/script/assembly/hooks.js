// Wires in the foam, and which seams are hooked to them, chosen in their order along the wire.

import { make, part, press, put } from "../dom.js";

/** @typedef {import("../store.js").Store} Store */

const LIKE = "hook";  // stage of a first scene in which hooks are pulled

export class Hooks {
  /** @param {Store} store @param {() => void} changed the list of seams is to be shown anew */
  constructor(store, changed) {
    this.store = store;
    this.changed = changed;
    /** @type {string | null} wire that seams are being chosen for */
    this.wire = null;
    /** @type {string[]} */
    this.chain = [];
  }

  get wires() {
    const framed = new Set(this.store.now.frames.map(({ curve }) => curve));
    return this.store.now.wires.map(({ name }) => String(name)).filter((name) => !framed.has(name));
  }

  /** Seams that are hooked to a wire now. @param {string} wire @returns {string[]} */
  linesOn(wire) {
    const own = this.store.now.hooks.filter((hook) => hook.wire === wire);
    return own.flatMap(({ line, chain }) => (chain ? chain : line ? [line] : []));
  }

  /** A seam is chosen, or no longer. @param {string} seam */
  toggle(seam) {
    this.chain = this.chain.includes(seam) ? this.chain.filter((name) => name !== seam) : [...this.chain, seam];
    this.show();
  }

  /** @param {string | null} wire */
  begin(wire) {
    this.wire = wire;
    this.chain = [];
    this.show();
    this.changed();
  }

  show() {
    const { wires } = this;
    put(part("wire-list"), ...(wires.length ? wires.map((wire) => (wire === this.wire ? this.editor(wire) : this.row(wire)))
      : [make("li", { class: "hint" }, "There is no wire in this foam.")]));
  }

  /** @param {string} wire */
  row(wire) {
    const lines = this.linesOn(wire);
    return make("li", { class: "wire" },
      make("span", { class: "name" }, wire),
      press("Hook seams to it", () => this.begin(wire), { "data-key": `wire ${wire}`, "aria-label": `Hook seams to ${wire}` }),
      make("span", { class: "figures" }, lines.length ? lines.join(", ") : "Nothing is hooked to it."));
  }

  /** @param {string} wire */
  editor(wire) {
    return make("li", { class: "open editor" },
      make("p", {}, make("strong", {}, wire), ": choose its seams in the list below, from one end of the wire to the other."),
      make("p", { class: "figures", role: "status" }, this.chain.length ? this.chain.join(", then ") : "None yet."),
      make("div", { class: "acts" },
        press(`Hook ${this.chain.length}`, () => void this.write(wire), { class: "main", id: "hook-done", disabled: this.chain.length === 0, "data-key": "hook done" }),
        this.linesOn(wire).length > 0 && press("Unhook all", () => void this.write(wire), { "data-key": "hook none", disabled: this.chain.length > 0 }),
        press("Leave it as it is", () => this.begin(null), { "data-key": "hook cancel" })));
  }

  /** Let the chosen seams take the place of what was hooked to a wire. @param {string} wire */
  async write(wire) {
    const { hooks, stages } = this.store.now, { chain } = this;
    const old = hooks.flatMap((hook, index) => (hook.wire === wire ? [index] : []));
    const stage = hooks[old[0]]?.stage ?? (stages.find(({ name }) => name === LIKE) ?? stages[stages.length - 1])?.name;
    const edits = old.reverse().map((index) => /** @type {import("../store.js").Edit} */ ({ kind: "hook.remove", index }));
    const lines = chain.length === 1 ? { line: chain[0] } : { chain };
    if (chain.length) edits.push({ kind: "hook.add", values: { name: wire, ...lines, wire, stage, slides: true } });
    const words = chain.length ? `${chain.length} seams are hooked to ${wire}.` : `Nothing is hooked to ${wire}.`;
    if (await this.store.edit(edits, words)) this.begin(null);
  }
}
