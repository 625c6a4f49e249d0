// Points of a light for some numbers of samples.

import { discPoint } from "./drawing/lights.js";

window.probed = JSON.parse(document.getElementById("content").textContent).counts.map(
  (count) => Array.from({ length: count }, (_, index) => discPoint(index)),
);
