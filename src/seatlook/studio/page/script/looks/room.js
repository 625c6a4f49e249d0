// Materials of the panels, lights and views.

import { hexOf } from "../../../../report/viewer/script/colour.js";
import { choiceField, draw, make, numberField, part, press, put } from "../dom.js";

/** @typedef {import("../store.js").Store} Store */

const NAMED_VIEWS = ["front_34", "driver_door", "rear_34", "top", "detail"];
/** @type {Record<string, string>} */
const LIGHT_WORDS = {
  lumen: "Power, lm", illuminance_lux: "Brightness, lx", elevation_deg: "Elevation, degrees", azimuth_deg: "Azimuth, degrees",
  radius_mm: "Radius, mm", temperature_k: "Colour temperature, K",
};

/** @typedef {import("../types.js").MaterialCard} MaterialCard */

/** @param {string} name of a material, or of its file in the folder */
const titleOf = (name) => name.replace(/^materials\//, "").replace(/\.toml$/, "");

/** A disc of the material's colour. @param {Record<string, any> | undefined} appearance */
function swatch(appearance) {
  const albedo = appearance?.albedo;
  const colour = Array.isArray(albedo) ? hexOf(albedo) : "#888888";
  return draw("svg", { viewBox: "0 0 64 64", width: 64, height: 64, class: "swatch", "aria-hidden": "true" },
    draw("circle", { cx: 32, cy: 32, r: 30, fill: colour }));
}

/** @param {MaterialCard} card */
function wordsOfCard({ kind, own, values: { fabric, appearance } }) {
  return [
    own ? "of this folder" : "", kind === "look" ? "a look only" : "", fabric?.thickness_mm ? `${fabric.thickness_mm} mm thick` : "",
    appearance?.roughness ? `roughness ${appearance.roughness}` : "",
  ].filter(Boolean).join(", ");
}

/** @param {Record<string, unknown>} source */
function sourcesOf(source) {
  const rows = Object.entries(source).flatMap(([key, text]) => [make("dt", {}, key.replaceAll("_", " ")), make("dd", {}, String(text))]);
  return make("details", {}, make("summary", {}, "Sources"), make("dl", {}, ...rows));
}

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
    return this.store.materials.filter(({ kind }) => kind === "cover").map(({ name }) => ({ value: name, text: titleOf(name) }));
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
    const covers = this.store.materials.filter(({ kind }) => kind !== "foam");
    put(part("material-cards"), ...covers.map((card) => make("li", { class: "card" },
      swatch(card.values.appearance),
      make("span", { class: "name" }, titleOf(card.name)),
      make("span", { class: "hint" }, wordsOfCard(card)),
      card.values.source ? sourcesOf(card.values.source) : null,
      press("Edit a copy", () => {
        const name = `${titleOf(card.name)}-own`;
        void this.store.edit([{ kind: "material.copy", material: card.name, name }], `The copy ${name} lies in the folder now.`)
          .then(() => this.store.loadMaterials());
      }, { "data-key": `copy ${card.name}`, "aria-label": `Edit a copy of ${titleOf(card.name)}` }))));
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
