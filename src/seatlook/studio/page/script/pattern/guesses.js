// Seams that the edges suggest, with how sure each is: accepted or refused, one by one or together.

import { make, numberField, press } from "../dom.js";

/** @typedef {import("../types.js").Guess} Guess */
/** @typedef {import("../store.js").Store} Store */
/** @typedef {{bound: number, lit: string | null, setBound: (bound: number) => void,
 *   light: (id: string | null) => void}} Way */

/** Edges that two guesses both want can be sewn only once: the surer one has them. @param {Guess[]} guesses */
export function apartFrom(guesses) {
  /** @type {Set<string>} */
  const taken = new Set();
  return guesses.filter(({ first, second }) => {
    const edges = [...first.edges, ...second.edges];
    if (edges.some((edge) => taken.has(edge))) return false;
    for (const edge of edges) taken.add(edge);
    return true;
  });
}

/** @param {number} count */
const guessWords = (count) => `${count} ${count === 1 ? "guess" : "guesses"}`;

/**
 * @param {Store} store
 * @param {Way} way
 * @returns {HTMLElement[]}
 */
export function guessList(store, way) {
  const { guesses } = store.now;
  if (guesses.length === 0) return [make("p", { class: "hint" }, "There is no guess for what is still free.")];
  const sure = apartFrom(guesses.filter(({ probability }) => probability >= way.bound));
  const rest = guesses.filter(({ probability }) => probability < way.bound);
  return [
    make("div", { class: "acts" },
      numberField("At least this sure, %", Math.round(100 * way.bound), (percent) => way.setBound(percent / 100),
        { min: 0, max: 100, "data-key": "bound" }),
      press(`Accept ${guessWords(sure.length)}`, () => {
        void store.edit(sure.map(({ id }) => ({ kind: "guess.accept", id })), `${guessWords(sure.length)} accepted.`);
      }, { id: "accept-all", disabled: sure.length === 0, "data-key": "accept all" }),
      rest.length > 0 && press(`Refuse the other ${rest.length}`, () => {
        void store.edit(rest.map(({ id }) => ({ kind: "guess.refuse", id })), `${guessWords(rest.length)} refused.`);
      }, { id: "refuse-rest", "data-key": "refuse rest" })),
    make("ul", { class: "rows" }, ...guesses.map((guess) => guessRow(store, guess, way))),
  ];
}

/** @param {Store} store @param {Guess} guess @param {Way} way */
function guessRow(store, guess, way) {
  const { id, name, probability, reason, rivals, lengths_mm: lengths } = guess;
  const light = () => way.light(id);
  const percent = `${(100 * probability).toFixed(0)} %`;
  return make("li", { class: "guess-row", mouseenter: light, focusin: light, mouseleave: () => way.light(null) },
    make("span", { class: `number sure${probability >= way.bound ? "" : " weak"}` }, percent),
    make("span", { class: "name" }, name),
    make("span", { class: "acts" },
      press("Accept", () => void store.edit([{ kind: "guess.accept", id }], `${name} is sewn.`),
        { "data-key": `accept ${id}`, "aria-label": `Accept ${name}, ${percent}` }),
      press("Refuse", () => void store.edit([{ kind: "guess.refuse", id }], `${name} is refused.`),
        { "data-key": `refuse ${id}`, "aria-label": `Refuse ${name}` })),
    make("span", { class: "why" }, reason || (lengths ?? []).map((x) => `${x.toFixed(1)} mm`).join(" and "), rivals?.length ? ` Also possible: ${rivals.join("; ")}.` : ""));
}
