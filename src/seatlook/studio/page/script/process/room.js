// The process: stages on a line of time, their ramps, groups and seams.

import { choiceField, find, make, numberField, part, press, put, textField } from "../dom.js";
import { TimeLine } from "./timeline.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("../types.js").Stage} Stage */

const RAMP_WORDS = [{ value: "linear", text: "even" }, { value: "smooth", text: "slow at both ends" }];

export class ProcessRoom {
  /** @param {Store} store */
  constructor(store) {
    this.store = store;
    this.active = 0;
    this.line = new TimeLine(find("time-line", SVGSVGElement), {
      moved: ({ index, start_s: start, end_s: end }) => void this.move(index, start, end),
      chosen: (index) => { this.active = index; this.show(); },
    });
    part("stage-add").addEventListener("click", () => {
      const { stages } = store.now;
      const last = stages[stages.length - 1];
      this.active = stages.length;
      void store.edit([{
        kind: "stage.add", values: { name: freeName(stages), start_s: last?.end_s ?? 0, end_s: (last?.end_s ?? 0) + 0.3 },
      }], "A stage is added.");
    });
  }

  show() {
    const { stages } = this.store.now;
    this.active = Math.min(this.active, Math.max(stages.length - 1, 0));
    this.line.show(stages, this.active);
    put(part("stage-editor"), ...(stages[this.active] ? this.editor(stages[this.active], this.active) : []));
    this.snapshots();
  }

  /** @param {number} index @param {number} start @param {number} end */
  move(index, start, end) {
    const stage = this.store.now.stages[index];
    const edits = [];
    if (stage.start_s !== start) edits.push({ kind: "stage.set", index, key: "start_s", value: start });
    if (stage.end_s !== end) edits.push({ kind: "stage.set", index, key: "end_s", value: end });
    if (edits.length === 0) return Promise.resolve(false);
    return this.store.edit(edits, `${stage.name}: ${start.toFixed(2)} to ${end.toFixed(2)} s.`);
  }

  /** @param {Stage} stage @param {number} index */
  editor(stage, index) {
    const set = (/** @type {string} */ key, /** @type {unknown} */ value, /** @type {string} */ words) => {
      void this.store.edit([{ kind: "stage.set", index, key, value }], words);
    };
    const { name } = stage;
    return [
      make("h3", {}, `Stage: ${name}`),
      make("div", { class: "fields" },
        textField("Name", name, (to) => set("name", to, `${name} is called ${to} now.`), { "data-key": "stage name" }),
        numberField("Starts at, s", stage.start_s, (x) => set("start_s", x, `${name} starts at ${x} s.`), { min: 0, "data-key": "stage start" }),
        numberField("Ends at, s", stage.end_s, (x) => set("end_s", x, `${name} ends at ${x} s.`), { min: 0, "data-key": "stage end" }),
        choiceField("Pull grows", stage.ramp ?? "linear", RAMP_WORDS, (x) => set("ramp", x, `${name}: the pull grows ${x}.`), { "data-key": "stage ramp" }),
        textField("Group", stage.group ?? "", (x) => set("group", x || null, `${name} belongs to ${x}.`), { "data-key": "stage group" })),
      this.seamsOf(stage, index),
      make("div", { class: "acts" }, press("Remove this stage", () => {
        void this.store.edit([{ kind: "stage.remove", index }], `${name} is removed.`);
      }, { "data-key": "stage remove" })),
    ];
  }

  /** @param {Stage} stage @param {number} index */
  seamsOf(stage, index) {
    const own = new Set(stage.seams ?? []);
    const { seams } = this.store.now;
    const boxes = seams.map(({ name, number }) => {
      const box = make("input", { type: "checkbox", "data-key": `stage seam ${name}`, change: () => {
        if (box.checked) own.add(name);
        else own.delete(name);
        const value = seams.map((seam) => seam.name).filter((one) => own.has(one));
        void this.store.edit([{ kind: "stage.set", index, key: "seams", value: value.length ? value : null }], `${name}: ${box.checked ? "closes in" : "no longer closes in"} ${stage.name}.`);
      } });
      box.checked = own.has(name);
      return make("label", { class: "check" }, box, `${number} ${name}`);
    });
    return make("details", {},
      make("summary", {}, own.size ? `${own.size} seams close in this stage` : "No seam is named for this stage"),
      make("p", { class: "hint" }, "Seams that no stage names close in the first one."),
      make("div", { class: "checks" }, ...boxes));
  }

  snapshots() {
    const run = this.store.now.runs.find(({ snapshots, page_url: page }) => snapshots?.length && page);
    put(part("snapshots"), run && make("a", { href: run.page_url ?? "", target: "_blank", rel: "noopener" }, `${run.name}: ${run.snapshots?.join(", ")}`));
    part("snapshots-head").hidden = !run;
  }
}

/** @param {Stage[]} stages */
function freeName(stages) {
  const names = new Set(stages.map(({ name }) => name));
  let number = stages.length + 1;
  while (names.has(`stage ${number}`)) ++number;
  return `stage ${number}`;
}
