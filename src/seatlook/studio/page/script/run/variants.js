// Other scenes of the folder: the seat kept under a name, and compared with as it is now.

import { choiceField, make, part, press, put } from "../dom.js";

/** @typedef {import("../store.js").Store} Store */

export class Variants {
  /** @param {Store} store @param {(other: string) => void} compare */
  constructor(store, compare) {
    this.store = store;
    this.compare = compare;
    this.chosen = "";
    this.name = make("input", { type: "text", id: "variant-name" });
    this.name.value = "before";
  }

  /** @param {boolean} busy whether a run is going on */
  show(busy) {
    const { variants } = this.store.now;
    if (!variants.includes(this.chosen)) this.chosen = variants[0] ?? "";
    put(part("variant-form"),
      make("div", { class: "fields" },
        make("label", { class: "field" }, make("span", {}, "Name"), this.name),
        press("Keep the seat as it is", () => void this.keep(), { id: "variant-keep", "data-key": "variant keep" })),
      variants.length > 0 && make("div", { class: "fields" },
        choiceField("Kept", this.chosen, variants.map((value) => ({ value, text: value.replace(/\.toml$/, "") })),
          (name) => { this.chosen = name; }, { id: "variant-other", "data-key": "variant other" }),
        press("Compare", () => this.compare(this.chosen), { id: "run-compare", "data-key": "variant compare", disabled: busy })));
  }

  keep() {
    const name = this.name.value.trim();
    return this.store.edit([{ kind: "scene.copy", name }], `Kept as ${name}.`);
  }
}
