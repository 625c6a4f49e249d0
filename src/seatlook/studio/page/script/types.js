// What the server says of a folder.

/** @typedef {[number, number]} Place on the pattern [mm] */
/** @typedef {{at_mm: number, point_mm: Place}} Notch */
/** @typedef {{name: string, points_mm: Place[], length_mm: number, notches?: Notch[]}} Edge */
/** @typedef {{name: string, points_mm: Place[]}} Line */
/** @typedef {{name: string, outline_mm: Place[], cut_mm?: Place[] | null, grain_mm?: [Place, Place] | null,
 *   corners_mm: Place[], holes_mm?: Place[][], lines?: Line[], edges: Edge[]}} Panel */
/** @typedef {{panel: string, edges: string[], points_mm?: Place[][]}} Side edges that are only guessed
 *   come with their points */
/** @typedef {{name: string, number: number, first: Side, second: Side, ease_percent: number,
 *   lengths_mm: [number, number], kind?: string}} Seam */
/** @typedef {{id: string, name: string, first: Side, second: Side, probability: number, reason: string,
 *   rivals?: string[], lengths_mm?: [number, number]}} Guess */
/** @typedef {{name: string, start_s: number, end_s: number, group?: string | null, ramp?: string | null,
 *   seams?: string[]}} Stage */
/** @typedef {{first: Record<string, any>, second: Record<string, any>, reverse: boolean, lengths_mm: [number, number], ease_percent: number,
 *   rivals?: any[], warnings?: string[]}} Partner */
/** @typedef {{name: string, kind: "cover" | "look" | "foam", own: boolean, values: Record<string, any>}} MaterialCard */
/** @typedef {{name: string, status: string, stage: string, fraction: number | null, seconds_left: number | null,
 *   figures: Record<string, number | string>, errors: string[], found: string, reason: string, missed: string[],
 *   page_url?: string | null, images?: string[], files?: string[], command?: string, snapshots?: string[]}} Run */
/** @typedef {{file?: string, line?: number | null, key?: string, text: string}} Fault */
/** @typedef {{etag: string, folder: string | null, has_scene: boolean, scene: string | null, variants: string[], errors: Fault[], undo: string | number | boolean | null,
 *   redo: string | number | boolean | null, name: string,
 *   pattern: {panels: Panel[]} | null, seams: Seam[], guesses: Guess[], stages: Stage[],
 *   hooks: Record<string, any>[], wires: any[], frames: Record<string, any>[],
 *   placement?: Record<string, any>, panels: Record<string, Record<string, any>>, rigs: any[], camera: Record<string, any>,
 *   runs: Run[]}} State */

export {};
