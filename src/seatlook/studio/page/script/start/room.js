// The start: a demo seat, a surface with lines, or a pattern with foam; seen before it is taken.

import { choiceField, find, make, numberField, part, press, put } from "../dom.js";
import { Refusal, tell, upload } from "../api.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {Record<string, any>} Draft what a dry run says */

const SHAPES = ["cushion", "horseshoe", "backrest", "headrest", "box", "saddle"];
const UNITS = ["", "mm", "cm", "m", "inch"].map((value) => ({ value, text: value || "as the file says" }));
const UPS = [{ value: "", text: "as usual for the format" }, { value: "z", text: "z" }, { value: "y", text: "y" }];
/** @type {Record<string, {file: string, needed: boolean, key: string, accept: string}[]>} */
const FILES = {
  pattern: [
    { file: "Pattern (DXF)", needed: true, key: "file", accept: ".dxf" },
    { file: "Foam (OBJ, STL, PLY, GLB)", needed: true, key: "foam", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { file: "Wires in the foam (TOML), if there are any", needed: false, key: "wires", accept: ".toml" },
  ],
  surface: [
    { file: "Design surface (OBJ, PLY, GLB)", needed: true, key: "file", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { file: "Lines on it (TOML), if the surface has no groups", needed: false, key: "lines", accept: ".toml" },
    { file: "Foam (OBJ, STL, PLY, GLB)", needed: true, key: "foam", accept: ".obj,.stl,.ply,.glb,.gltf" },
    { file: "Wires in the foam (TOML), if there are any", needed: false, key: "wires", accept: ".toml" },
  ],
};

export class StartRoom {
  /** @param {Store} store @param {() => void} opened */
  constructor(store, opened) {
    this.store = store;
    this.opened = opened;
    this.shape = "cushion";
    this.scale = 1;
    for (const kind of ["pattern", "surface"]) this.form(kind);
    this.demo();
  }

  show() {
    const { state } = this.store;
    const out = state?.left_out ?? [];
    put(part("left-out"), ...out.map(leftOutRow));
    part("left-out-box").hidden = out.length === 0;
  }

  demo() {
    put(part("start-demo"),
      choiceField("Shape", this.shape, SHAPES.map((value) => ({ value, text: value })), (shape) => { this.shape = shape; }, { id: "demo-shape" }),
      numberField("Size, times the usual one", this.scale, (scale) => { this.scale = scale; }, { min: 0.6, max: 1.6 }),
      press("Make this seat", () => void this.take({ kind: "demo", shape: this.shape, scale: this.scale }, "demo"), { id: "demo-make", class: "main" }),
      make("div", { id: "seen-demo", "aria-live": "polite" }));
  }

  /** @param {string} kind */
  form(kind) {
    /** @type {Record<string, string>} */
    const draft = {};
    const send = (/** @type {boolean} */ dry) => this.take({ kind, ...draft, dry }, kind);
    const files = FILES[kind].map(({ file, needed, key, accept }) => {
      const input = make("input", { type: "file", accept, id: `${kind}-${key}`, required: needed });
      input.addEventListener("change", () => void this.fetchFile(input, key, draft, kind, send));
      return make("label", { class: "field" }, make("span", {}, file), input);
    });
    const words = (/** @type {string} */ key) => (/** @type {string} */ value) => {
      if (value) draft[key] = value;
      else delete draft[key];
      if (draft.file) void send(true);
    };
    put(part(`start-${kind}`), ...files,
      choiceField("Unit of the foam", "", UNITS, words("unit"), { id: `${kind}-unit` }),
      choiceField("Its upward axis", "", UPS, words("up"), { id: `${kind}-up` }),
      kind === "pattern" ? choiceField("Unit of the pattern", "", UNITS, words("units"), { id: "pattern-units" }) : null,
      make("div", { id: `seen-${kind}`, "aria-live": "polite" }),
      press("Take it", () => void send(false), { id: `${kind}-take`, class: "main", disabled: true }));
  }

  /**
   * Bring a file to the server and look at all that there is.
   * @param {HTMLInputElement} input
   * @param {string} key
   * @param {Record<string, string>} draft
   * @param {string} kind
   * @param {(dry: boolean) => Promise<void>} send
   */
  async fetchFile(input, key, draft, kind, send) {
    const file = input.files?.[0];
    if (!file) return;
    this.say(kind, `Reading ${file.name}…`);
    try {
      draft[key] = (await upload(file)).path;
    } catch (problem) {
      this.say(kind, problem instanceof Refusal ? problem.message : `${file.name} did not reach the server.`, true);
      return;
    }
    const ready = FILES[kind].every((one) => !one.needed || draft[one.key]);
    find(`${kind}-take`, HTMLButtonElement).disabled = !ready;
    await send(true);
  }

  /** @param {string} kind @param {string} text @param {boolean} [bad] */
  say(kind, text, bad = false) {
    put(part(`seen-${kind}`), make("p", { class: bad ? "bad-text" : "hint" }, text));
  }

  /** @param {Record<string, any>} asked @param {string} kind */
  async take(asked, kind) {
    this.say(kind, asked.dry ? "Looking at it…" : "Making the folder…");
    /** @type {Draft} */
    let seen;
    try {
      seen = await tell("/api/start", asked);
    } catch (problem) {
      this.say(kind, problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
      return;
    }
    if (asked.dry) {
      put(part(`seen-${kind}`), ...seenRows(seen));
      return;
    }
    this.say(kind, "");
    await this.store.load();
    this.opened();
  }
}

/** @param {{what: string, reason: string}} row */
const leftOutRow = ({ what, reason }) => make("li", {}, make("strong", {}, what), `: ${reason}`);

/** What a dry run says, as a list. @param {Draft} seen */
function seenRows(seen) {
  const rows = [];
  for (const [name, value] of Object.entries(seen.said ?? seen.seen ?? {})) {
    rows.push(make("dt", {}, name.replaceAll("_", " ")), make("dd", {}, Array.isArray(value) ? value.join(", ") : String(value)));
  }
  const out = seen.left_out ?? [];
  return [
    make("dl", {}, ...rows),
    out.length ? make("div", {}, make("p", {}, "Left out of the file:"), make("ul", {}, ...out.map(leftOutRow))) : null,
  ].filter((one) => one !== null);
}
