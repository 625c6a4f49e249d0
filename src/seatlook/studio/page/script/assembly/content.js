// What is drawn of a seat before it is solved: bodies, lines and faults from the server's answer.

/** @typedef {{kind: "seam" | "hook" | "frame", number: string | number, name: string, target: string, gap_mm: number,
 *   segments_mm: number[][]}} Tie segments as x, y, z of both ends */
/** @typedef {{name: string, points_mm: number[][]}} Curve */
/** @typedef {{kind: string, text: string, file?: string | null, line?: number | null, places_mm: number[][]}} Fault */
/** @typedef {{positions_mm: number[], triangles: number[]}} Skin row after row */
/** @typedef {{foam: Skin | null, panels: (Skin & {name: string})[], ties: Tie[], wires: Curve[], faults: Fault[],
 *   seconds?: number}} Assembly */
/** @typedef {import("./stage.js").Line} Line */

/** Seams are told apart by people who see no red or no green. */
export const SEAM_TINTS = [
  [0, 92, 171], [200, 82, 0], [0, 122, 94], [139, 60, 148], [112, 88, 24], [0, 130, 158], [178, 36, 110], [72, 72, 160],
];
const PANEL_TINTS = [
  [0.70, 0.78, 0.86], [0.86, 0.78, 0.70], [0.76, 0.84, 0.74], [0.84, 0.74, 0.80], [0.82, 0.82, 0.66], [0.70, 0.84, 0.84],
];
export const FOAM = [0.90, 0.85, 0.70];
const WIRE = [0.16, 0.16, 0.16], FRAME = [0.38, 0.41, 0.44], BORDER = [0.42, 0.38, 0.35];

/** @param {number} number of a panel */
export const panelTint = (number) => PANEL_TINTS[number % PANEL_TINTS.length];

/** @param {number[]} place [mm] */
const metres = (place) => place.map((x) => x / 1e3);

/** Ends of ties, one pair after the other [m]. @param {Tie} tie */
const pairsOf = (tie) => tie.segments_mm.flatMap((ends) => [metres(ends.slice(0, 3)), metres(ends.slice(3))]);

/** A curve as pairs of ends [m]. @param {Curve} curve */
const piecesOf = ({ points_mm: points }) => points.slice(1).flatMap((place, k) => [metres(points[k]), metres(place)]);

/** Edges that only one triangle has, as pairs of ends [m]. @param {Skin} skin */
function borderOf({ positions_mm: positions, triangles }) {
  /** @type {Map<string, number[] | null>} */
  const edges = new Map();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const ends = [triangles[t + k], triangles[t + (k + 1) % 3]];
      const key = ends[0] < ends[1] ? `${ends[0]} ${ends[1]}` : `${ends[1]} ${ends[0]}`;
      edges.set(key, edges.has(key) ? null : ends);
    }
  }
  return [...edges.values()].flatMap((ends) => (ends ? ends.map((k) => metres(positions.slice(3 * k, 3 * k + 3))) : []));
}

/** Number of a seam's colour. @param {Tie} tie */
export const tintNumber = (tie) => (Number(tie.number) - 1) % SEAM_TINTS.length;

/**
 * @param {Assembly} assembly
 * @param {string | null} chosen name of the seam that is shown
 * @returns {Line[]}
 */
export function linesOf(assembly, chosen) {
  /** @type {Line[]} */
  const lines = assembly.panels.map((panel) => ({ points: borderOf(panel), colour: BORDER, width: 1.2, lift: 0.0004 }));
  for (const wire of assembly.wires) lines.push({ points: piecesOf(wire), colour: WIRE, width: 4, lift: 0.0006 });
  for (const tie of assembly.ties) {
    const points = pairsOf(tie);
    if (tie.kind === "frame") lines.push({ points, colour: FRAME, width: 1.2, lift: 0.0005 });
    else if (tie.kind === "hook") lines.push({ points, colour: WIRE, width: 1.4, lift: 0.0005 });
    else {
      const lit = tie.name === chosen, colour = SEAM_TINTS[tintNumber(tie)].map((x) => x / 255);
      lines.push({ points, colour, width: lit ? 4 : 1.8, lift: lit ? 0.002 : 0.0008 });
    }
  }
  return lines;
}

/** Place [m] halfway along a seam's ties, for its number. @param {Tie} tie */
export function middleOfTie(tie) {
  const pairs = pairsOf(tie);
  if (pairs.length < 2) return null;
  const k = 2 * Math.floor(pairs.length / 4);
  return pairs[k].map((x, i) => (x + pairs[k + 1][i]) / 2);
}

/** Places [m] of a fault. @param {Fault} fault */
export const placesOf = (fault) => fault.places_mm.map(metres);
