// Lights at other places.

import { moved, placeOf } from "./drawing/lights.js";

const { lights, middle, places } = JSON.parse(document.getElementById("content").textContent);

window.probed = {
  same: lights.map((light) => moved(light, middle, placeOf(light, middle))),
  moved: lights.map((light) => places.map((place) => moved(light, middle, place))),
};
