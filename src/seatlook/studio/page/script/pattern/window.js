// The part of the sheet that is seen: shifted by dragging, enlarged by the wheel, both by keys.

const CLOSEST = 40;  // mm across, at most so near
const DRAG = 4;  // px after which a press is no click

export class Window {
  /**
   * @param {SVGSVGElement} svg
   * @param {() => void} scaled
   * @param {(event: PointerEvent) => void} clicked
   */
  constructor(svg, scaled, clicked) {
    this.svg = svg;
    this.scaled = scaled;
    this.clicked = clicked;
    this.box = { x: 0, y: 0, width: 1000, height: 600 };
    this.whole = { width: 1000, height: 600 };
    /** @type {{x: number, y: number, moved: boolean} | null} */
    this.press = null;
    svg.addEventListener("pointerdown", (event) => this.down(event));
    svg.addEventListener("pointermove", (event) => this.drag(event));
    svg.addEventListener("pointerup", (event) => this.up(event));
    svg.addEventListener("pointercancel", () => { this.press = null; });
    svg.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    new ResizeObserver(() => this.fitAspect()).observe(svg);
  }

  /** @param {number} width @param {number} height of all that can be seen [mm] */
  fit(width, height) {
    this.whole = { width, height };
    this.box = { x: 0, y: 0, width, height };
    this.fitAspect();
  }

  get aspect() {
    return Math.max(this.svg.clientWidth, 1) / Math.max(this.svg.clientHeight, 1);
  }

  fitAspect() {
    const { box, aspect } = this;
    const middle = [box.x + box.width / 2, box.y + box.height / 2];
    if (box.width / box.height < aspect) box.width = box.height * aspect;
    else box.height = box.width / aspect;
    [box.x, box.y] = [middle[0] - box.width / 2, middle[1] - box.height / 2];
    this.apply();
  }

  apply() {
    const { x, y, width, height } = this.box;
    this.svg.setAttribute("viewBox", `${x.toFixed(3)} ${y.toFixed(3)} ${width.toFixed(3)} ${height.toFixed(3)}`);
    this.scaled();
  }

  /** Millimetres per pixel of the screen. */
  get pixel() {
    return this.box.width / Math.max(this.svg.clientWidth, 1);
  }

  /** Place on the sheet of an event. @param {MouseEvent} event */
  placeOf(event) {
    const area = this.svg.getBoundingClientRect();
    return [
      this.box.x + (event.clientX - area.left) * this.pixel, this.box.y + (event.clientY - area.top) * this.pixel,
    ];
  }

  /** @param {number} times @param {number[]} [around] a place on the sheet */
  zoom(times, around) {
    const { box } = this;
    const most = 2 * Math.max(this.whole.width, this.whole.height * this.aspect);
    const width = Math.min(most, Math.max(CLOSEST, box.width / times));
    const share = width / box.width;
    const [x, y] = around ?? [box.x + box.width / 2, box.y + box.height / 2];
    this.box = { x: x + (box.x - x) * share, y: y + (box.y - y) * share, width, height: box.height * share };
    this.apply();
  }

  /** @param {number} x @param {number} y shares of the window */
  pan(x, y) {
    this.box.x += x * this.box.width;
    this.box.y += y * this.box.height;
    this.apply();
  }

  /** Shift the window where a place on the sheet is not in it. @param {ArrayLike<number>} place */
  reveal(place) {
    const { box } = this;
    const inside = place[0] > box.x && place[0] < box.x + box.width && place[1] > box.y && place[1] < box.y + box.height;
    if (inside) return;
    [box.x, box.y] = [place[0] - box.width / 2, place[1] - box.height / 2];
    this.apply();
  }

  /** @param {PointerEvent} event */
  down(event) {
    if (event.button > 1) return;
    this.press = { x: event.clientX, y: event.clientY, moved: false };
    this.svg.focus({ preventScroll: true });
  }

  /** @param {PointerEvent} event */
  drag(event) {
    const { press } = this;
    if (!press || !event.buttons) return;
    const step = [event.clientX - press.x, event.clientY - press.y];
    if (!press.moved && Math.hypot(...step) < DRAG) return;
    if (!press.moved) this.svg.setPointerCapture(event.pointerId);
    press.moved = true;
    this.box.x -= step[0] * this.pixel;
    this.box.y -= step[1] * this.pixel;
    [press.x, press.y] = [event.clientX, event.clientY];
    this.apply();
  }

  /** @param {PointerEvent} event */
  up(event) {
    const { press } = this;
    this.press = null;
    if (press && !press.moved && event.button === 0) this.clicked(event);
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    if (event.ctrlKey) return;
    event.preventDefault();
    this.zoom(Math.exp(-event.deltaY / (event.deltaMode ? 20 : 500)), this.placeOf(event));
  }
}
