// The command line that draws what is shown.

import { along, towards } from "./drawing/matrix.js";
import { stateOf } from "./drawing/camera.js";

/** @typedef {import("./scene.js").Scene} Scene */
/** @typedef {import("./drawing/camera.js").State} State */

// From right above, a place alone does not say which side is up: the command looks from a little aside.
const HIGHEST = Math.PI / 2 - 1e-3;

/**
 * One word for a shell. Quotes of this kind are the same for all of them, unless there is in the
 * name what a shell would read; then they are those of POSIX.
 * @param {string} word
 */
export function quoted(word) {
  if (/^[\w./:-]+$/.test(word)) return word;
  return /["$`\\!%]/.test(word) ? `'${word.replace(/'/g, "'\\''")}'` : `"${word}"`;
}

/** A path that no command takes for an option. @param {string} path */
const file = (path) => quoted(path.startsWith("-") ? `./${path}` : path);

/** @param {number[]} place [m] */
const millimetres = (place) => place.map((x) => Number((1e3 * x).toFixed(2))).join(" ");

/**
 * Where the camera is, if that is not a view with a name.
 * @param {Scene} scene
 */
function placeWords(scene) {
  const { state } = scene.camera;
  const named = scene.content.views.find(({ name }) => name === state.view);
  if (named && JSON.stringify(stateOf(named)) === JSON.stringify(state)) return [];
  const elevation = Math.min(HIGHEST, Math.max(-HIGHEST, state.elevation));
  const position = along(state.target, state.distance, towards(state.azimuth, elevation));
  return [`--position-mm ${millimetres(position)}`, `--target-mm ${millimetres(state.target)}`];
}

/**
 * The command, to be run in the folder of the scene; it takes light and look as the scene has them.
 * @param {Scene} scene
 */
export function commandOf(scene) {
  const [path, result] = scene.content.files;
  return [
    "seatlook render", file(path), file(result), "--out view", `--texture=${quoted(scene.lookName)}`,
    `--rig=${quoted(scene.base.name)}`, `--view=${quoted(scene.camera.state.view)}`, ...placeWords(scene),
    ...(scene.layer < 0 ? ["--no-maps"] : []),
  ].join(" ");
}
