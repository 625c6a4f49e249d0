// Pictures of the viewer's renderer as radiance over white, and how long they take.

import { Renderer } from "./drawing/renderer.js";
import { Scene } from "./scene.js";
import { arraysOf } from "./drawing/payload.js";

async function start() {
  const content = JSON.parse(document.getElementById("content").textContent);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = content.size;
  const began = performance.now();
  const array = await arraysOf(content.buffers);
  const renderer = new Renderer(canvas, content, array);
  const scene = new Scene(content);
  const shown = () => {
    const { middle } = renderer.mesh;
    return {
      rig: scene.rig(middle), ...scene.materials(), layer: -1, ev100: scene.ev100(middle), camera: scene.camera, photo: null,
    };
  };
  renderer.refill(shown());
  renderer.move(shown());
  const opened = performance.now() - began;

  // Radiance [cd/m2] as base64 of float32, red, green, blue, from the lowest row up.
  const picture = (look, rig, samples) => {
    Object.assign(scene, { lookNumber: look, rigNumber: rig });
    renderer.refill(shown());
    renderer.restart();
    while (renderer.rest(shown(), samples));
    const { gl } = renderer, { width, height, sum: frame } = renderer.seen;
    const sum = new Float32Array(4 * width * height), out = new Float32Array(3 * width * height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, sum);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const white = 1.2 * Math.pow(2, shown().ev100) / renderer.done, paper = renderer.paper(shown());
    for (let k = 0; k < width * height; ++k) {
      for (let c = 0; c < 3; ++c) {
        out[3 * k + c] = white * (sum[4 * k + c] + (renderer.done - sum[4 * k + 3]) * paper[c]);
      }
    }
    const bytes = new Uint8Array(out.buffer);
    let text = "";
    for (let k = 0; k < bytes.length; k += 3 * 8192) text += btoa(String.fromCharCode(...bytes.subarray(k, k + 3 * 8192)));
    return text;
  };

  const choose = (look, rig) => {
    Object.assign(scene, { lookNumber: look, rigNumber: rig });
    renderer.refill(shown());
  };
  const resize = (width, height) => {
    [canvas.width, canvas.height] = [width, height];
  };
  // Milliseconds of some frames while the seat turns, each at 1 / scale of its size.
  const frames = (count, scale) => {
    const state = { ...scene.camera.state }, { width, height } = canvas;
    const before = performance.now();
    for (let k = 0; k < count; ++k) {
      scene.camera.turn(0.02, 0);
      const size = [Math.round(width / scale), Math.round(height / scale)];
      renderer.seen.clear();
      renderer.sample(shown(), size, 0, 1);
      renderer.display(size, 1, shown());
      renderer.wait();
    }
    scene.camera.state = state;
    return performance.now() - before;
  };
  // Milliseconds of a picture at rest.
  const still = (samples) => {
    const before = performance.now();
    renderer.restart();
    while (renderer.rest(shown(), samples));
    return performance.now() - before;
  };
  const { faces } = renderer.mesh;
  return { opened, picture, choose, resize, frames, still, triangles: faces.length / 3 };
}

window.probed = start();
