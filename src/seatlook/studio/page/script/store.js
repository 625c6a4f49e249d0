// What is known of the folder: one state, changed by edits that the server has written to its files.

import { Refusal, ask, tell } from "./api.js";

/** @typedef {import("./types.js").State} State */
/** @typedef {Record<string, any> & {kind: string}} Edit */

export class Store {
  /** @param {{say: (text: string, bad?: boolean) => void, conflict: (refusal: Refusal, again: () => void) => void}} voice */
  constructor(voice) {
    this.voice = voice;
    /** @type {State | null} */
    this.state = null;
    /** @type {Array<(state: State) => void>} */
    this.listeners = [];
    /** @type {Promise<unknown>} */
    this.queue = Promise.resolve();
    this.waiting = 0;
    /** @type {import("./types.js").MaterialCard[]} */
    this.materials = [];
  }

  /** @returns {State} */
  get now() {
    if (!this.state) throw new Error("nothing is known yet");
    return this.state;
  }

  /** @param {(state: State) => void} listener */
  listen(listener) {
    this.listeners.push(listener);
  }

  /** @param {State} state */
  take(state) {
    this.state = state;
    for (const listener of this.listeners) listener(state);
  }

  async load() {
    this.take(await ask("/api/state"));
  }

  /** What there is to make a cover of. */
  async loadMaterials() {
    this.materials = (await ask("/api/materials")).materials;
    if (this.state) this.take(this.state);
  }

  /**
   * Change files; changes are made one after the other.
   * @param {Edit[]} edits one step of undo
   * @param {string} done what is said once they are written
   * @returns {Promise<boolean>} whether they are
   */
  edit(edits, done) {
    return this.send("/api/edit", () => ({ base: this.now.etag, edits }), done);
  }

  undo() {
    return this.send("/api/undo", () => ({ base: this.now.etag }), "Taken back.");
  }

  redo() {
    return this.send("/api/redo", () => ({ base: this.now.etag }), "Done again.");
  }

  /**
   * @param {string} path
   * @param {() => Record<string, unknown>} body made when it is its turn
   * @param {string} done
   * @returns {Promise<boolean>}
   */
  send(path, body, done) {
    this.waiting += 1;
    const sent = this.queue.then(() => this.deliver(path, body, done)).finally(() => { this.waiting -= 1; });
    this.queue = sent;
    return sent;
  }

  /** @param {string} path @param {() => Record<string, unknown>} body @param {string} done */
  async deliver(path, body, done) {
    try {
      this.take(await tell(path, body()));
      this.voice.say(done);
      return true;
    } catch (problem) {
      if (problem instanceof Refusal && problem.status === 409) {
        this.voice.conflict(problem, () => void this.send(path, body, done));
      } else {
        this.voice.say(problem instanceof Refusal ? problem.message : "The studio's server does not answer. Nothing was changed.", true);
      }
      return false;
    }
  }
}
