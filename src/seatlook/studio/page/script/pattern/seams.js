// The list of seams: number, colour, both lengths, ease; turned, renamed or removed.

import { make, press, textField } from "../dom.js";
import { tintOf } from "./sheet.js";

/** @typedef {import("../types.js").Seam} Seam */
/** @typedef {import("../store.js").Store} Store */

/** A share without the sign of a nought. @param {number} percent */
export const percentWords = (percent) => `${(Math.round(10 * percent) / 10 || 0).toFixed(1)} %`;

/** Lengths of both sides and how they differ. @param {Seam} seam */
export function lengthsOf({ lengths_mm: [a, b], ease_percent: ease }) {
  return `${a.toFixed(1)} to ${b.toFixed(1)} mm, ease ${percentWords(ease)}`;
}

/**
 * @param {Store} store
 * @param {string | null} chosen name of the seam that can be changed
 * @param {(name: string) => void} choose
 * @returns {HTMLElement[]}
 */
export function seamList(store, chosen, choose) {
  const { seams } = store.now;
  if (seams.length === 0) {
    return [make("p", { class: "hint" }, "Nothing is sewn yet. Accept guesses below, or sew by four picks in the drawing.")];
  }
  const rows = seams.map((seam) => make("li", { class: seam.name === chosen ? "open" : "" },
    make("button", {
      type: "button", class: "row", "aria-expanded": String(seam.name === chosen), "data-key": `seam ${seam.name}`,
      click: () => choose(seam.name),
    },
    make("span", { class: `number ${tintOf(seam.number)}` }, String(seam.number)),
    make("span", { class: "name" }, seam.name),
    make("span", { class: `figures${Math.abs(seam.ease_percent) > 5 ? " odd" : ""}` }, lengthsOf(seam))),
    seam.name === chosen && editor(store, seam)));
  return [make("ol", { class: "rows" }, ...rows)];
}

/** @param {Store} store @param {Seam} seam */
function editor(store, seam) {
  const { name } = seam;
  /** @type {Record<string, string>} */
  const kinds = { seam: "two edges", chain: "a chain of edges", dart: "a dart", tube: "closes a tube" };
  return make("div", { class: "editor" },
    textField("Name", name, (to) => void store.edit([{ kind: "seam.rename", name, to }], `${name} is called ${to} now.`),
      { "data-key": `rename ${name}` }),
    make("p", { class: "hint" }, `It joins ${kinds[seam.kind ?? "seam"] ?? seam.kind}: ${seam.first.edges.join(", ")} to ${seam.second.edges.join(", ")}. What another ease would do is shown under "Run".`),
    make("div", { class: "acts" },
      press("Turn", () => void store.edit([{ kind: "seam.turn", name }], `${name} is sewn the other way round.`),
        { "data-key": `turn ${name}`, title: "Sew the partner from its other end" }),
      press("Remove", () => void store.edit([{ kind: "seam.remove", name }], `${name} is removed.`), { "data-key": `remove ${name}` })));
}
