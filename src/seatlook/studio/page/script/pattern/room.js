// The pattern's room: the sheet, four picks, seams and guesses, all by mouse and by keyboard.

import { find, make, part, press, put } from "../dom.js";
import { Refusal, tell } from "../api.js";
import { Cursor, likelyPartner } from "./keys.js";
import { lengthOf, middleOf } from "./ring.js";
import { STEPS, Sewing } from "./sewing.js";
import { Sheet } from "./sheet.js";
import { guessList } from "./guesses.js";
import { percentWords, seamList } from "./seams.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("../types.js").Partner} Partner */
/** @typedef {import("./sheet.js").Pick} Pick */

const PAN = 0.1;
const MOST = 10;  // % by which two sides of a seam may differ, as everywhere

export class PatternRoom {
  /** @param {Store} store */
  constructor(store) {
    this.store = store;
    this.svg = find("sheet", SVGSVGElement);
    this.sheet = new Sheet(this.svg, {
      pick: (pick) => this.pick(pick), hover: (pick) => this.hover(pick), seam: (name) => this.choose(name),
      sewing: () => this.sewing.step > 0,
    });
    this.sewing = new Sewing(() => this.sheet.rings);
    this.cursor = new Cursor(() => this.sheet.rings);
    /** @type {Pick | null} */
    this.pointed = null;
    /** @type {{seam: string | null, guess: string | null, names: boolean}} */
    this.chosen = { seam: null, guess: null, names: false };
    this.bound = 0.9;
    /** @type {Partner | null} */
    this.doubt = null;
    this.svg.addEventListener("keydown", (event) => this.key(event));
    this.svg.addEventListener("focus", () => this.point(this.cursor.pick));
    this.svg.addEventListener("blur", () => this.point(null));
    const names = find("sheet-names", HTMLInputElement);
    names.addEventListener("change", () => {
      this.chosen.names = names.checked;
      this.drawSeams();
    });
    part("sheet-whole").addEventListener("click", () => this.sheet.showAll());
    part("sheet-in").addEventListener("click", () => this.sheet.window.zoom(1.5));
    part("sheet-out").addEventListener("click", () => this.sheet.window.zoom(1 / 1.5));
  }

  show() {
    const { pattern } = this.store.now;
    const there = pattern !== null && pattern.panels.length > 0;
    part("pattern-none").hidden = there;
    part("pattern-room").hidden = !there;
    if (!there) return;
    this.sheet.setPanels(pattern.panels);
    if (this.chosen.seam && !this.store.now.seams.some(({ name }) => name === this.chosen.seam)) this.chosen.seam = null;
    if (this.sewing.picks.some(({ panel }) => !this.sheet.rings.has(panel))) this.sewing.clear();
    this.drawSeams();
    this.showSteps();
  }

  drawSeams() {
    const { seams, guesses } = this.store.now;
    this.sheet.setSeams(seams, guesses, this.chosen);
    this.showLists();
  }

  showLists() {
    put(part("seam-list"), ...seamList(this.store, this.chosen.seam, (name) => this.choose(name)));
    put(part("guess-list"), ...guessList(this.store, {
      bound: this.bound, lit: this.chosen.guess, setBound: (bound) => { this.bound = bound; this.showLists(); },
      light: (id) => this.light(id),
    }));
  }

  /** @param {string} name of a seam */
  choose(name) {
    this.chosen.seam = this.chosen.seam === name ? null : name;
    this.drawSeams();
    if (this.chosen.seam) part("seam-list").querySelector("[aria-expanded=true]")?.scrollIntoView({ block: "nearest" });
  }

  /** @param {string | null} id of a guess */
  light(id) {
    if (id === this.chosen.guess) return;
    this.chosen.guess = id;
    const { seams, guesses } = this.store.now;
    this.sheet.setSeams(seams, guesses, this.chosen);
  }

  /** What is pointed at: by the mouse, or else by the keyboard's cursor. @param {Pick | null} pick */
  point(pick) {
    this.pointed = pick;
    this.showPicks();
  }

  /** @param {Pick | null} pick */
  hover(pick) {
    const keyboard = document.activeElement === this.svg ? this.cursor.pick : null;
    this.point(pick ? this.sewing.settled(pick) : keyboard);
    const edge = pick && this.sheet.rings.get(pick.panel)?.edgeAt(pick.arc);
    part("sheet-here").textContent = edge ? `${edge.name}, ${edge.length_mm.toFixed(1)} mm` : "";
  }

  /** @param {Pick} near where it was clicked */
  pick(near) {
    // While an answer is waited for there is nothing to pick; after a doubt the last pick is made anew.
    if (this.sewing.step === 4 && !this.doubt) return;
    if (this.doubt) this.back();
    const pick = this.sewing.settled(near);
    const objection = this.sewing.objection(pick);
    if (objection) {
      this.store.voice.say(objection, true);
      return;
    }
    this.doubt = null;
    this.sewing.take(pick);
    this.cursor.to(pick);
    if (this.sewing.step === 2) this.goToPartner();
    if (this.sewing.step === 4) void this.sew();
    this.showSteps();
  }

  /** The keyboard's cursor goes to where the partner is likely to start. */
  goToPartner() {
    const line = this.sewing.first(null);
    if (!line) return;
    const points = this.sewing.ring(line.panel).stretch(line.from, line.way);
    const sewn = new Set(this.store.now.seams.flatMap(({ first, second }) => [...first.edges, ...second.edges]));
    const start = likelyPartner(this.sheet.rings, sewn, {
      panel: line.panel, length: lengthOf(points), middle: middleOf(points),
    });
    if (start) this.cursor.to(start);
  }

  /** Ask for the partner's end, and sew if nothing speaks against it. */
  async sew() {
    /** @type {Partner} */
    let partner;
    try {
      partner = await tell("/api/partner", this.sewing.question());
    } catch (problem) {
      this.store.voice.say(problem instanceof Refusal ? problem.message : "The studio's server does not answer.", true);
      this.sewing.back();
      this.showSteps();
      return;
    }
    if (partner.warnings?.length) {
      this.doubt = partner;
      this.showSteps();
      part("sew-doubt").querySelector("button")?.focus();
    } else await this.join(partner);
  }

  /** @param {Partner} partner */
  async join({ first, second, reverse, lengths_mm: [a, b], ease_percent: ease }) {
    this.doubt = null;
    this.sewing.clear();
    this.showSteps();
    const words = `Sewn: ${a.toFixed(1)} mm to ${b.toFixed(1)} mm, ease ${percentWords(ease)}.`;
    await this.store.edit([{ kind: "seam.add", first, second, reverse }], words);
    if (document.activeElement === this.svg) this.point(this.cursor.pick);
  }

  showSteps() {
    const { step } = this.sewing;
    const now = Math.min(step, STEPS.length - 1);
    put(part("sew-step"), make("strong", {}, `${now + 1} of 4 `), STEPS[now]);
    put(part("sew-acts"),
      step > 0 && press("Take back the pick", () => this.back(), { "data-key": "back" }),
      step === 2 && press("Other way round", () => this.turnAround(), { "data-key": "around" }),
      step > 0 && press("Begin anew", () => this.cancel(), { "data-key": "cancel" }));
    const { doubt } = this;
    part("sew-doubt").hidden = doubt === null;
    put(part("sew-doubt"), doubt && make("p", {}, `${doubt.lengths_mm[0].toFixed(1)} mm to ${doubt.lengths_mm[1].toFixed(1)} mm. ${(doubt.warnings ?? []).join(" ")}`),
      doubt && Math.abs(doubt.ease_percent) <= MOST && press("Sew it all the same", () => { void this.join(doubt); this.svg.focus(); }, { id: "sew-anyway" }),
      doubt && press("Take back the last pick", () => { this.back(); this.svg.focus(); }));
    this.showPicks();
  }

  showPicks() {
    const { sewing, sheet, pointed } = this;
    const dots = sewing.picks.map(({ panel, arc }) => ({ panel, place: sewing.ring(panel).at(arc), look: "pick" }));
    if (pointed && sheet.rings.has(pointed.panel)) {
      dots.push({ panel: pointed.panel, place: sewing.ring(pointed.panel).at(pointed.arc), look: "cursor" });
    }
    sheet.lay(sewing.marks(pointed), dots);
    part("sew-lengths").textContent = sewing.words(pointed);
  }

  back() {
    this.doubt = null;
    this.sewing.back();
    this.showSteps();
  }

  cancel() {
    this.doubt = null;
    this.sewing.clear();
    this.showSteps();
  }

  turnAround() {
    if (this.sewing.step !== 2) return;
    this.sewing.around = !this.sewing.around;
    this.showSteps();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (!this.windowKey(event) && !this.sewKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {KeyboardEvent} event @returns {boolean} whether it was one of the window's keys */
  windowKey(event) {
    const { window: view } = this.sheet;
    /** @type {Record<string, [number, number]>} */
    const ways = { ArrowLeft: [-PAN, 0], ArrowRight: [PAN, 0], ArrowUp: [0, -PAN], ArrowDown: [0, PAN] };
    if (event.shiftKey && ways[event.key]) view.pan(...ways[event.key]);
    else if (event.key === "+" || event.key === "=") view.zoom(1.3);
    else if (event.key === "-") view.zoom(1 / 1.3);
    else if (event.key === "0") this.sheet.showAll();
    else return false;
    return true;
  }

  /** @param {KeyboardEvent} event @returns {boolean} */
  sewKey(event) {
    /** @type {Record<string, () => void>} */
    const steps = {
      ArrowRight: () => this.cursor.along(1), ArrowLeft: () => this.cursor.along(-1),
      ArrowDown: () => this.cursor.across(1), ArrowUp: () => this.cursor.across(-1),
    };
    /** @type {Record<string, () => void>} */
    const acts = {
      Backspace: () => this.back(), Escape: () => this.cancel(), f: () => this.turnAround(),
      Enter: () => this.pickCursor(), " ": () => this.pickCursor(),
    };
    if (steps[event.key]) {
      steps[event.key]();
      this.atCursor();
    } else if (acts[event.key]) acts[event.key]();
    else return false;
    return true;
  }

  pickCursor() {
    if (this.cursor.pick) this.pick(this.cursor.pick);
    this.atCursor();
  }

  atCursor() {
    const { pick } = this.cursor;
    this.point(pick);
    part("sheet-here").textContent = this.cursor.words;
    if (pick) this.sheet.window.reveal(this.sheet.on(pick.panel, this.sewing.ring(pick.panel).at(pick.arc)));
  }
}
