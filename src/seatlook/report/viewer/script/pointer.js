// Turn, shift and zoom by mouse, touch and keyboard; a click that did not drag picks.

/** @typedef {import("./drawing/camera.js").Camera} Camera */

const TURN = Math.PI;  // per height of the picture
const STEP = 0.06;

export class Pointer {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Camera} camera
   * @param {() => void} moved
   * @param {(x: number, y: number) => void} picked x and y from -1 to 1
   */
  constructor(canvas, camera, moved, picked) {
    Object.assign(this, { canvas, camera, moved, picked });
    this.canvas = canvas;
    this.camera = camera;
    this.moved = moved;
    this.picked = picked;
    this.rows = 1;  // of seats, one above the other
    /** @type {Map<number, number[]>} */
    this.held = new Map();
    this.travel = 0;
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => this.release(/** @type {PointerEvent} */ (event)));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /** @param {PointerEvent} event */
  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.held.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.held.size === 1) this.travel = 0;
    this.canvas.focus({ preventScroll: true });
  }

  /** @param {PointerEvent} event */
  drag(event) {
    const before = this.held.get(event.pointerId);
    if (!before) return;
    const height = this.canvas.clientHeight / this.rows;
    const step = [(event.clientX - before[0]) / height, (event.clientY - before[1]) / height];
    const others = [...this.held].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
    this.held.set(event.pointerId, [event.clientX, event.clientY]);
    this.travel += Math.hypot(...step) * height;
    if (others.length) {
      const apart = (/** @type {number[]} */ at) => Math.hypot(at[0] - others[0][0], at[1] - others[0][1]);
      this.camera.zoom(Math.max(apart([event.clientX, event.clientY]), 1) / Math.max(apart(before), 1));
      this.camera.pan(step[0] / 2, step[1] / 2);
    } else if (event.buttons & 6 || event.shiftKey) {
      this.camera.pan(step[0], step[1]);
    } else {
      this.camera.turn(-TURN * step[0], TURN * step[1]);
    }
    this.moved();
  }

  /** @param {PointerEvent} event */
  release(event) {
    const alone = this.held.size === 1 && this.held.delete(event.pointerId);
    this.held.delete(event.pointerId);
    if (!alone || this.travel > 4 || event.type !== "pointerup" || event.button !== 0) return;
    const area = this.canvas.getBoundingClientRect();
    const x = (event.clientX - area.left) / area.width, y = (event.clientY - area.top) / area.height;
    this.picked(2 * x - 1, 1 - 2 * y);
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    if (event.ctrlKey) return;
    event.preventDefault();
    this.camera.zoom(Math.exp(-event.deltaY / (event.deltaMode ? 20 : 600)));
    this.moved();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    /** @type {Record<string, number[]>} */
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const arrow = arrows[event.key];
    if (arrow && event.shiftKey) this.camera.pan(STEP * arrow[0], STEP * arrow[1]);
    else if (arrow) this.camera.turn(-TURN * STEP * arrow[0], TURN * STEP * arrow[1]);
    else if (event.key === "+" || event.key === "=") this.camera.zoom(1.15);
    else if (event.key === "-") this.camera.zoom(1 / 1.15);
    else if (event.key === "Enter") this.picked(0, 0);
    else return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key !== "Enter") this.moved();
  }
}
