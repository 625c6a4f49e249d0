// Materials of the panels, lights and views.

import { choiceField, make, numberField, part, press, put } from "../dom.js";

/** @typedef {import("../store.js").Store} Store */

const NAMED_VIEWS = ["front_34", "driver_door", "rear_34", "top", "detail"];
/** @type {Record<string, string>} */
const LIGHT_WORDS = {
  lumen: "Power, lm", illuminance_lux: "Brightness, lx", elevation_deg: "Elevation, degrees", azimuth_deg: "Azimuth, degrees",
  radius_mm: "Radius, mm", temperature_k: "Colour temperature, K",
};

export class LooksRoom {
  /** @param {Store} store */
  constructor(store) {
    this.store = store;
  }

  show() {
    this.panels();
    this.library();
    this.rigs();
    this.views();
  }

  get choices() {
    return (this.store.now.materials ?? []).map(({ name, title }) => ({ value: name, text: title || name }));
  }

  panels() {
    const { panels } = this.store.now;
    const names = Object.keys(panels);
    const rows = names.map((name) => make("li", {}, choiceField(name, panels[name].material ?? "", this.choices, (value) => {
      void this.store.edit([{ kind: "panel.set", panel: name, key: "material", value }], `${name} is made of ${value}.`);
    }, { "data-key": `material ${name}` })));
    const all = choiceField("All panels", "", [{ value: "", text: "choose…" }, ...this.choices], (value) => {
      if (!value) return;
      void this.store.edit(names.map((panel) => ({ kind: "panel.set", panel, key: "material", value })), `All panels are made of ${value}.`);
    }, { "data-key": "material all" });
    put(part("panel-materials"), names.length ? all : null, make("ul", { class: "fields plain" }, ...rows));
  }

  library() {
    put(part("material-cards"), ...(this.store.now.materials ?? []).map(({ name, title, swatch_url: swatch, source }) => make("li", { class: "card" },
      swatch ? make("img", { src: swatch, alt: "", width: 96, height: 96 }) : make("span", { class: "no-swatch", "aria-hidden": "true" }),
      make("span", { class: "name" }, title || name),
      source ? make("span", { class: "hint" }, source) : null,
      press("Edit a copy", () => {
        void this.store.edit([{ kind: "material.copy", material: name, name: `${name}-own` }], `A copy of ${title || name} lies in the folder now.`);
      }, { "data-key": `copy ${name}`, "aria-label": `Edit a copy of ${title || name}` }))));
  }

  rigs() {
    put(part("rig-list"), ...this.store.now.rigs.map((rig, index) => make("fieldset", {},
      make("legend", {}, rig.name),
      ...(rig.light ?? []).map((/** @type {Record<string, any>} */ light, /** @type {number} */ k) => make("div", { class: "fields" },
        make("span", { class: "kind" }, light.kind),
        ...Object.keys(LIGHT_WORDS).filter((key) => typeof light[key] === "number").map((key) => numberField(
          LIGHT_WORDS[key], light[key], (value) => {
            void this.store.edit([{ kind: "rig.set", index, key: ["light", k, key], value }], `${rig.name}: ${LIGHT_WORDS[key]} is ${value}.`);
          }, { "data-key": `rig ${index} ${k} ${key}` })))))));
  }

  views() {
    const camera = this.store.now.camera ?? {};
    const own = new Set(camera.views ?? []);
    put(part("view-list"), ...NAMED_VIEWS.map((name) => {
      const box = make("input", { type: "checkbox", "data-key": `view ${name}`, change: () => {
        if (box.checked) own.add(name);
        else own.delete(name);
        const value = NAMED_VIEWS.filter((view) => own.has(view));
        void this.store.edit([{ kind: "camera.set", key: "views", value }], `Views: ${value.join(", ")}.`);
      } });
      box.checked = own.has(name);
      return make("label", { class: "check" }, box, name.replace("_", " "));
    }));
  }
}
