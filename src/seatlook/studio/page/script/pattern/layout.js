// Where panels lie on the sheet: in rows, as the window is shaped.

/** @typedef {import("../types.js").Panel} Panel */
/** @typedef {{x: number, y: number}} Shift from pattern (x, -y) to the sheet [mm] */

const GAP = 0.06;  // of the largest panel, between panels

/**
 * Put panels in rows so that they fill a window of this aspect best.
 * @param {Panel[]} panels
 * @param {number} aspect width over height
 * @returns {{shifts: Map<string, Shift>, width: number, height: number}}
 */
export function laidOut(panels, aspect) {
  const boxes = panels.map((panel) => {
    const points = [...panel.outline_mm, ...(panel.cut_mm ?? [])];
    const xs = points.map(([x]) => x), ys = points.map(([, y]) => y);
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    return { name: panel.name, left, high, width: right - left, height: high - low };
  });
  // Panels of one height stand side by side; those of one height stay in their order.
  boxes.sort((a, b) => Math.round((b.height - a.height) / (0.1 * Math.max(a.height, b.height))));
  const gap = GAP * Math.max(1, ...boxes.map(({ width, height }) => Math.max(width, height)));
  const widest = Math.max(1, ...boxes.map(({ width }) => width));
  const whole = boxes.reduce((sum, { width }) => sum + width + gap, 0);
  let best = inRows(boxes, whole, gap);
  for (let k = 0; k <= 24; ++k) {
    const tried = inRows(boxes, widest + (whole - widest) * k / 24, gap);
    if (sizeIn(tried, aspect) < sizeIn(best, aspect)) best = tried;
  }
  return best;
}

/** Width of a window of this aspect that holds a layout. @param {{width: number, height: number}} layout @param {number} aspect */
const sizeIn = (layout, aspect) => Math.max(layout.width, layout.height * aspect);

/**
 * @param {{name: string, left: number, high: number, width: number, height: number}[]} boxes
 * @param {number} most width of a row
 * @param {number} gap
 */
function inRows(boxes, most, gap) {
  /** @type {Map<string, Shift>} */
  const shifts = new Map();
  let x = gap, y = gap, tallest = 0, width = 0;
  for (const box of boxes) {
    if (x > gap && x + box.width > most + gap) [x, y, tallest] = [gap, y + tallest + gap, 0];
    shifts.set(box.name, { x: x - box.left, y: y + box.high });
    x += box.width + gap;
    width = Math.max(width, x);
    tallest = Math.max(tallest, box.height);
  }
  return { shifts, width, height: y + tallest + gap };
}
