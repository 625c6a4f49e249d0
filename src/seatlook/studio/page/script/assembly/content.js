// What is drawn of a seat before it is solved: bodies, lines and faults from the server's answer.

/** @typedef {number[][]} Points [mm] */
/** @typedef {{name?: string, seam?: string, number?: number | string, segments_mm?: number[][][], points_mm?: Points,
 *   target?: string}} Tie */
/** @typedef {{kind: string, sentence: string, file?: string | null, line?: number | null, places_mm: Points}} Fault */
/** @typedef {{foam: {positions_mm: Points, triangles: number[][]} | null,
 *   panels: {name: string, positions_mm: Points, triangles: number[][]}[], ties: Tie[], wires: Tie[], hooks: Tie[],
 *   frames: Tie[], faults: Fault[], seconds?: number}} Assembly */
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

/** Points of a line as pairs of ends [m]. @param {Tie} tie */
function pairsOf(tie) {
  if (tie.segments_mm) return tie.segments_mm.flatMap(([a, b]) => [metres(a), metres(b)]);
  const points = tie.points_mm ?? [];
  return points.slice(1).flatMap((place, k) => [metres(points[k]), metres(place)]);
}

/**
 * Edges that only one triangle has.
 * @param {Points} positions
 * @param {number[][]} triangles
 */
function borderOf(positions, triangles) {
  /** @type {Map<string, number[] | null>} */
  const edges = new Map();
  for (const triangle of triangles) {
    for (let k = 0; k < 3; ++k) {
      const ends = [triangle[k], triangle[(k + 1) % 3]];
      const key = ends[0] < ends[1] ? `${ends[0]} ${ends[1]}` : `${ends[1]} ${ends[0]}`;
      edges.set(key, edges.has(key) ? null : ends);
    }
  }
  return [...edges.values()].flatMap((ends) => (ends ? ends.map((k) => metres(positions[k])) : []));
}

/**
 * @param {Assembly} assembly
 * @param {string | null} seam the one that is chosen
 * @returns {Line[]}
 */
export function linesOf(assembly, seam) {
  /** @type {Line[]} */
  const lines = assembly.panels.map(({ positions_mm: positions, triangles }) => ({
    points: borderOf(positions, triangles), colour: BORDER, width: 1.2, lift: 0.0004,
  }));
  for (const wire of assembly.wires) lines.push({ points: pairsOf(wire), colour: WIRE, width: 4, lift: 0.0006 });
  for (const frame of assembly.frames) lines.push({ points: pairsOf(frame), colour: FRAME, width: 1.2, lift: 0.0005 });
  for (const hook of assembly.hooks) lines.push({ points: pairsOf(hook), colour: WIRE, width: 1.4, lift: 0.0005 });
  assembly.ties.forEach((tie, k) => {
    const number = Number(tie.number ?? k + 1);
    const colour = SEAM_TINTS[(number - 1) % SEAM_TINTS.length].map((x) => x / 255);
    const name = tie.seam ?? tie.name;
    lines.push({ points: pairsOf(tie), colour, width: name === seam ? 4 : 1.8, lift: name === seam ? 0.002 : 0.0008 });
  });
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
