// One seat, or two side by side, seen by one camera: each is drawn in its part of the picture.

/** @typedef {import("./drawing/renderer.js").Renderer} Renderer */
/** @typedef {import("./drawing/renderer.js").Shown} Shown */
/** @typedef {import("./drawing/payload.js").Content} Content */
/** @typedef {import("./drawing/mesh.js").Mesh} Mesh */

const APART = 2;  // pixels between two parts

export class Panes {
  /**
   * @param {Renderer} renderer
   * @param {(content: Content) => Shown} shownOf
   */
  constructor(renderer, shownOf) {
    this.renderer = renderer;
    this.shownOf = shownOf;
    this.first = renderer.pane;
    /** @type {import("./drawing/pane.js").Pane | null} kept once made */
    this.second = null;
    this.pair = false;
    this.at = 0;
  }

  get list() {
    return this.pair && this.second ? [this.first, this.second] : [this.first];
  }

  /** Whether two seats lie one below the other. */
  get stacked() {
    const { width, height } = this.renderer.canvas;
    return height > width;
  }

  /** Show this seat beside the first. @param {Content} content @param {Mesh} mesh */
  beside(content, mesh) {
    this.second ??= this.first.another(content, mesh);
    this.second.put(content, mesh);
    this.pair = true;
  }

  /** Give each its part of the picture. */
  layOut() {
    const { width, height } = this.renderer.canvas;
    if (!this.pair || !this.second) {
      this.first.area = null;
      return;
    }
    const w = this.stacked ? width : Math.max(1, (width - APART) >> 1);
    const h = this.stacked ? Math.max(1, (height - APART) >> 1) : height;
    this.first.area = [0, height - h, w, h];
    this.second.area = [width - w, 0, w, h];
  }

  /** Width over height of the part of each. */
  get aspect() {
    const [, , width, height] = this.renderer.area;
    return width / height;
  }

  /** A place of the whole picture as one of its part, x and y from -1 to 1. @param {number} x @param {number} y */
  inside(x, y) {
    if (!this.pair) return [x, y];
    const part = (/** @type {number} */ at) => 2 * at + (at < 0 ? 1 : -1);
    return this.stacked ? [x, part(y)] : [part(x), y];
  }

  /** Materials have changed. */
  refill() {
    for (const pane of this.list) {
      this.renderer.pane = pane;
      this.renderer.refill(this.shownOf(pane.content));
    }
  }

  /** Begin the pictures anew. */
  restart() {
    this.layOut();
    this.at = 0;
    this.renderer.restart();
  }

  /** One coarse sample of each. */
  move() {
    for (const pane of this.list) {
      this.renderer.pane = pane;
      this.renderer.move(this.shownOf(pane.content));
    }
    this.restart();
  }

  /** The next sample at rest, of one after the other; false once all are there. */
  rest() {
    const pane = this.list[this.at];
    if (!pane) return false;
    this.renderer.pane = pane;
    if (!this.renderer.rest(this.shownOf(pane.content))) {
      this.at += 1;
      this.renderer.restart();
    }
    return this.at < this.list.length;
  }
}
