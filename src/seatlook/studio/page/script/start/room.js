// The start: a demo seat, a surface with lines, or a pattern with foam; seen before it is taken.

import { choiceField, find, make, numberField, part, press, put } from "../dom.js";
import { Refusal, tell, upload } from "../api.js";
import { LibraryShelf } from "./library.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {{files: Record<string, string>, keys: Record<string, string>}} Draft what is asked for so far */
/** @typedef {{notes: string[], left_out: {what: string, reason: string}[], mm_per_unit?: number, surface_mm?: number[],
 *   foam_mm?: number[], foam_axes?: {unit: string, up: string}, wires?: string[],
 *   pieces: {name: string, size_mm?: number[], notches?: number}[]}} Seen */

const SHAPES = ["cushion", "horseshoe", "backrest", "headrest", "box", "saddle"];
const UNITS = ["", "mm", "cm", "m", "inch"].map((value) => ({ value, text: value || "as the file says" }));
const ENCODINGS = ["", "utf-8", "cp1252", "gb18030", "shift_jis", "euc_kr"].map((value) => ({ value, text: value || "guessed" }));
const UPS = [{ value: "", text: "as usual for the format" }, { value: "z", text: "z" }, { value: "y", text: "y" }];
/** @type {Record<string, {text: string, needed: boolean, key: string, accept: string}[]>} */
const FILES = {
  pattern: [
    { text: "Pattern (DXF)", needed: true, key: "pattern", accept: ".dxf" },
    { text: "Foam (OBJ, STL, PLY, GLB)", needed: true, key: "foam", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { text: "Wires in the foam (TOML), if there are any", needed: false, key: "wires", accept: ".toml" },
  ],
  surface: [
    { text: "Design surface (OBJ, PLY, GLB)", needed: true, key: "surface", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { text: "Seam lines on it (TOML), if it has no groups", needed: false, key: "lines", accept: ".toml" },
    { text: "Foam (OBJ, STL, PLY, GLB)", needed: true, key: "foam", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { text: "Wires in the foam (TOML), if there are any", needed: false, key: "wires", accept: ".toml" },
  ],
};

export class StartRoom {
  /** @param {Store} store @param {() => void} opened */
  constructor(store, opened) {
    this.store = store;
    this.opened = opened;
    this.shape = "cushion";
    this.scale = 1;
    /** @type {Record<string, Draft>} */
    this.drafts = {};
    for (const kind of ["pattern", "surface"]) this.form(kind);
    this.demo();
    this.library = new LibraryShelf((state, entry) => this.fromLibrary(state, entry));
  }

  show() {
    part("start-replace").hidden = !this.store.state?.has_scene;
  }

  demo() {
    put(part("start-demo"),
      choiceField("Shape", this.shape, SHAPES.map((value) => ({ value, text: value })), (shape) => { this.shape = shape; }, { id: "demo-shape" }),
      numberField("Size, times the usual one", this.scale, (scale) => { this.scale = scale; }, { min: 0.6, max: 1.6 }),
      press("Make this seat", () => void this.take({ kind: "demo", choices: { shape: this.shape, scale: this.scale } }, "demo"), { id: "demo-make", class: "main" }),
      make("div", { id: "seen-demo", "aria-live": "polite" }));
  }

  /** @param {string} kind */
  form(kind) {
    /** @type {Draft} */
    const draft = { files: {}, keys: {} };
    this.drafts[kind] = draft;
    const files = FILES[kind].map(({ text, needed, key, accept }) => {
      const input = make("input", { type: "file", accept, id: `${kind}-${key}`, required: needed });
      input.addEventListener("change", () => void this.fetchFile(input, key, draft, kind));
      return make("label", { class: "field" }, make("span", {}, text), input);
    });
    const set = (/** @type {string} */ key) => (/** @type {string} */ value) => {
      if (value) draft.keys[key] = value;
      else delete draft.keys[key];
      if (this.ready(kind, draft)) void this.take(asked(kind, draft, true), kind);
    };
    put(part(`start-${kind}`), ...files,
      kind === "pattern" ? choiceField("Unit of the pattern", "", UNITS, set("units"), { id: "pattern-units" }) : null,
      choiceField("Unit of the foam", "", UNITS, set("unit"), { id: `${kind}-unit` }),
      choiceField("Its upward axis", "", UPS, set("up"), { id: `${kind}-up` }),
      kind === "pattern" ? choiceField("Letters of its names", "", ENCODINGS, set("encoding"), { id: "pattern-encoding" }) : null,
      make("div", { id: `seen-${kind}`, "aria-live": "polite" }),
      press("Take it", () => void this.take(asked(kind, draft, false), kind), { id: `${kind}-take`, class: "main", disabled: true }));
  }

  /**
   * A pattern or foam stands for a chosen file; all else is in the folder now.
   * @param {any} state
   * @param {import("./library.js").Entry} entry
   */
  fromLibrary(state, entry) {
    this.store.take(state);
    if (!state.files_to_start) {
      if (entry.kind === "seat") this.opened();
      return;
    }
    for (const [kind, draft] of Object.entries(this.drafts)) {
      for (const { key } of FILES[kind]) {
        if (!(key in state.files_to_start)) continue;
        draft.files[key] = state.files_to_start[key];
        find(`${kind}-${key}`, HTMLInputElement).required = false;
      }
      const ready = this.ready(kind, draft);
      find(`${kind}-take`, HTMLButtonElement).disabled = !ready;
      if (ready) void this.take(asked(kind, draft, true), kind);
      else this.say(kind, `${entry.label} of the library is here.`);
    }
  }

  /** @param {string} kind @param {Draft} draft */
  ready(kind, draft) {
    return FILES[kind].every((one) => !one.needed || draft.files[one.key]);
  }

  /**
   * Bring a file to the server and, once all that is needed is there, say what would be read.
   * @param {HTMLInputElement} input
   * @param {string} key
   * @param {Draft} draft
   * @param {string} kind
   */
  async fetchFile(input, key, draft, kind) {
    const file = input.files?.[0];
    if (!file) return;
    this.say(kind, `Reading ${file.name}…`);
    try {
      draft.files[key] = (await upload(file)).path;
    } catch (problem) {
      this.say(kind, problem instanceof Refusal ? problem.message : `${file.name} did not reach the server.`, true);
      return;
    }
    const ready = this.ready(kind, draft);
    find(`${kind}-take`, HTMLButtonElement).disabled = !ready;
    if (ready) await this.take(asked(kind, draft, true), kind);
    else this.say(kind, `${file.name} is here.`);
  }

  /** @param {string} kind @param {string} text @param {boolean} [bad] */
  say(kind, text, bad = false) {
    put(part(`seen-${kind}`), make("p", { class: bad ? "bad-text" : "hint" }, text));
  }

  /** @param {Record<string, any>} asked @param {string} kind */
  async take(asked, kind) {
    this.say(kind, asked.dry ? "Looking at it…" : "Making the folder…");
    /** @type {Seen & import("../types.js").State} */
    let seen;
    try {
      const force = find("start-force", HTMLInputElement).checked;
      seen = await tell("/api/start", force ? { ...asked, force } : asked);
    } catch (problem) {
      this.say(kind, problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
      return;
    }
    if (asked.dry) {
      put(part(`seen-${kind}`), ...seenRows(seen));
      return;
    }
    this.say(kind, "");
    this.store.take(seen);
    this.opened();
  }
}

/** @param {{what: string, reason: string}} row */
const leftOutRow = ({ what, reason }) => make("li", {}, make("strong", {}, what), `: ${reason}`);

/** @param {string} kind @param {Draft} draft @param {boolean} dry whether it is only looked at */
const asked = (kind, draft, dry) => ({
  kind, files: draft.files, ...draft.keys, dry, ...(kind === "pattern" ? { guesses: "ask" } : {}),
});

/** @param {number[]} sizes [mm] */
const sizeWords = (sizes) => `${sizes.map((x) => x.toFixed(0)).join(" x ")} mm`;

/** What would be taken, and what would not. @param {Seen} seen */
function seenRows(seen) {
  /** @type {[string, string | false | undefined][]} */
  const rows = [
    ["Pieces", `${seen.pieces.length}: ${seen.pieces.map(({ name }) => name).join(", ")}`],
    ["Largest piece", seen.pieces[0]?.size_mm && sizeWords(largest(seen))],
    ["Unit of the pattern", seen.mm_per_unit !== undefined && `${seen.mm_per_unit} mm`],
    ["Design surface", seen.surface_mm && sizeWords(seen.surface_mm)],
    ["Foam", seen.foam_mm && `${sizeWords(seen.foam_mm)}, read in ${seen.foam_axes?.unit}, ${seen.foam_axes?.up} up`],
    ["Wires", seen.wires && seen.wires.join(", ")],
  ];
  return [
    make("dl", {}, ...rows.flatMap(([name, value]) => (value ? [make("dt", {}, name), make("dd", {}, value)] : []))),
    ...seen.notes.map((note) => make("p", { class: "hint" }, note)),
    ...(seen.left_out.length ? [make("p", {}, "Left out of the file:"), make("ul", {}, ...seen.left_out.map(leftOutRow))] : []),
  ];
}

/** @param {Seen} seen */
function largest({ pieces }) {
  const sizes = pieces.map(({ size_mm: size }) => size ?? [0, 0]);
  return sizes.reduce((best, size) => (Math.max(...size) > Math.max(...best) ? size : best), [0, 0]);
}
