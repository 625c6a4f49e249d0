// The viewer: opened on demand, drawn when something has changed, gone without harm.

import { Controls, drawBar } from "./controls.js";
import { Knowledge } from "./here.js";
import { Panes } from "./panes.js";
import { Pointer } from "./pointer.js";
import { Renderer } from "./drawing/renderer.js";
import { Scene } from "./scene.js";
import { Mesh } from "./drawing/mesh.js";
import { arraysOf, seatOf } from "./drawing/payload.js";
import { commandOf } from "./command.js";
import { box, button, element, handOut, input, say } from "./page.js";
import { pageOf, sentChoice } from "./send.js";
import { photoOf, readPhoto } from "./photo.js";
import { photoTexture } from "./drawing/materials.js";

/** @typedef {import("./drawing/renderer.js").Shown} Shown */
/** @typedef {import("./drawing/payload.js").Content} Content */
/** @typedef {import("./drawing/payload.js").Page} Page */
/** @typedef {import("./drawing/payload.js").Numbers} Numbers */

const STILL = 150;  // ms without a change after which a fine picture is begun

class Viewer {
  /**
   * @param {Page} page
   * @param {(name: string) => Numbers} array
   * @param {string} room the section as it was
   */
  constructor(page, array, room) {
    this.page = page;
    this.array = array;
    this.room = room;
    this.canvas = element("canvas", HTMLCanvasElement);
    this.fit();
    this.renderer = new Renderer(this.canvas, page, array);
    this.scene = new Scene(page);
    this.panes = new Panes(this.renderer, (content) => this.shown(content));
    /** @type {{data: string, picture: ImageBitmap, texture: WebGLTexture} | null} */
    this.photo = null;
    /** @type {{content: Content, mesh: Mesh, knowledge: Knowledge}[]} */
    this.seats = [{ content: page, mesh: this.renderer.mesh, knowledge: new Knowledge(page, array) }];
    this.bars = ["viridis", "diverging"].map(array);
    // Lights stay where they are when another seat is shown.
    this.middle = this.renderer.mesh.middle;
    this.controls = new Controls(this.scene, this.middle, {
      moved: () => this.moved(), look: () => this.relook(), photo: (file) => void this.takePhoto(file),
      resized: () => this.moved(), fly: (wrinkle) => this.fly(wrinkle),
      seat: (number) => void this.change(number), beside: (number) => void this.pair(number),
    }, page.others);
    this.pointer = new Pointer(this.canvas, this.scene.camera, () => this.moved(), (x, y) => this.pick(x, y));
    this.stir = 0;
    this.asked = 0;
    this.coarse = false;
    this.listen();
    this.showSeat();
    this.panes.refill();
  }

  listen() {
    button("reset").addEventListener("click", () => this.reset());
    button("save").addEventListener("click", () => void this.save());
    button("toml").addEventListener("click", () => {
      void this.copy(this.scene.toml(this.middle), "");
    });
    button("command").addEventListener("click", () => void this.copyCommand());
    button("send").addEventListener("click", () => this.send());
    new ResizeObserver(() => {
      if (this.fit()) this.moved();
    }).observe(this.canvas);
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      cancelAnimationFrame(this.asked);
      shut("The graphics card stopped. The pictures on this page stay.");
    });
    // The page's own keys stay out of what is typed here.
    box("room").addEventListener("keydown", (event) => {
      if (event.key !== "Escape") event.stopPropagation();
    });
    for (const kind of ["dragover", "drop"]) {
      box("room").addEventListener(kind, (event) => {
        event.preventDefault();
        const file = /** @type {DragEvent} */ (event).dataTransfer?.files[0];
        if (kind === "drop" && file) void this.takePhoto(file);
      });
    }
  }

  /** One pixel of the picture is one of the screen. */
  fit() {
    const times = window.devicePixelRatio;
    const width = Math.max(1, Math.round(this.canvas.clientWidth * times));
    const height = Math.max(1, Math.round(this.canvas.clientHeight * times));
    if (this.canvas.width === width && this.canvas.height === height) return false;
    [this.canvas.width, this.canvas.height] = [width, height];
    return true;
  }

  /** What is to be seen of a seat. @param {Content} content @returns {Shown} */
  shown(content) {
    const { scene, photo, middle } = this;
    const { materials, look } = scene.materials(content);
    const width = Number(input("photo-size").value) / 1e3;
    return {
      rig: scene.rig(middle), materials, look, layer: scene.layer, ev100: scene.ev100(middle), camera: scene.camera,
      photo: photo && width > 0 ? {
        texture: photo.texture, pixels: [photo.picture.width, photo.picture.height],
        size: [width, width * photo.picture.height / photo.picture.width],
      } : null,
    };
  }

  /**
   * Show another seat of the page, from the same place and in the same light.
   * @param {number} number
   */
  async change(number) {
    this.scene.seatNumber = number;
    const { content, mesh } = await this.seat(number);
    // Another one may have been chosen while this one was made ready.
    if (this.scene.seatNumber !== number) return;
    this.panes.first.put(content, mesh);
    this.scene.content = content;
    this.rename();
    this.showSeat();
    this.relook();
  }

  /**
   * Show one more seat beside it, by the same camera; none for -1.
   * @param {number} number
   */
  async pair(number) {
    this.scene.besideNumber = number;
    const seat = number < 0 ? null : await this.seat(number);
    if (this.scene.besideNumber !== number) return;
    if (seat) this.panes.beside(seat.content, seat.mesh);
    else this.panes.pair = false;
    box("glass").toggleAttribute("data-pair", seat !== null);
    this.fit();
    this.rename();
    this.controls.show();
    this.relook();
  }

  /** A seat of the page, made ready where it is not yet. @param {number} number */
  async seat(number) {
    delete box("room").dataset.still;
    if (!this.seats[number]) {
      const { content, array } = await seatOf(this.page, this.array, number);
      const mesh = new Mesh(this.renderer.gl, content, array);
      this.seats[number] ??= { content, mesh, knowledge: new Knowledge(content, array) };
    }
    return this.seats[number];
  }

  /** Those that are shown, the first one first. */
  get shownSeats() {
    const found = this.panes.list.map(({ content }) => this.seats.find((seat) => seat?.content === content));
    return found.filter((seat) => seat !== undefined);
  }

  /** Say in the picture which seat is which, and nothing of a place of others. */
  rename() {
    box("here").textContent = "";
    ["first", "second"].forEach((place, k) => {
      box(`${place}-name`).hidden = !this.panes.pair;
      box(`${place}-name`).textContent = this.shownSeats[k]?.content.name ?? "";
    });
  }

  /** What differs from seat to seat in the controls. */
  showSeat() {
    button("command").hidden = this.scene.content.files.length === 0;
    this.controls.offerWrinkles();
    this.controls.show();
  }

  /** Something has changed: draw it coarsely now, and finely once all is still. */
  moved() {
    this.stir = performance.now();
    delete box("room").dataset.still;
    this.panes.restart();
    this.pointer.rows = this.panes.pair && this.panes.stacked ? 2 : 1;
    if (this.scene.layer >= 0) drawBar(this.bars[this.scene.content.maps[this.scene.layer].low < 0 ? 1 : 0]);
    this.coarse = true;
    this.ask();
  }

  relook() {
    this.panes.refill();
    this.moved();
  }

  ask() {
    cancelAnimationFrame(this.asked);
    this.asked = requestAnimationFrame(() => this.frame());
  }

  frame() {
    if (this.coarse) {
      this.coarse = false;
      this.panes.move();
      this.ask();
    } else if (performance.now() - this.stir < STILL) {
      this.ask();
    } else if (this.panes.rest()) {
      this.ask();
    } else {
      box("room").dataset.still = "yes";
    }
  }

  /** Of two seats, both are asked at the same place of their parts. @param {number} x @param {number} y */
  pick(x, y) {
    const { scene: { camera }, panes } = this;
    // Between two of them lies the middle of the whole picture: from the keyboard, that of each is meant.
    const [u, v] = x === 0 && y === 0 ? [0, 0] : panes.inside(x, y);
    const ray = camera.ray(u, v, panes.aspect);
    box("here").textContent = this.shownSeats.map(({ content, mesh, knowledge }) => {
      const hit = mesh.hit(camera.position, ray);
      return `${panes.pair ? content.name : "Here"}: ${hit ? knowledge.at(mesh, hit) : "nothing of the seat."}`;
    }).join("\n");
  }

  /** @param {number} number */
  fly(number) {
    const wrinkle = this.scene.content.wrinkles[number];
    this.scene.camera.flyTo(wrinkle.position, wrinkle.normal, wrinkle.length);
    box("here").textContent = `Wrinkle ${wrinkle.label}; mostly by ${wrinkle.cause}.`;
    this.moved();
  }

  reset() {
    this.scene.changes = {};
    this.photo = null;
    input("photo").value = "";
    this.controls.show();
    this.relook();
  }

  /** @param {Blob} file */
  async takePhoto(file) {
    try {
      const { picture, data } = await readPhoto(file);
      this.lay(picture, data);
      say("");
    } catch (problem) {
      say(`This is no photo that can be read: ${problem instanceof Error ? problem.message : problem}`);
    }
  }

  /** @param {ImageBitmap} picture @param {string} data */
  lay(picture, data) {
    if (this.photo) this.renderer.gl.deleteTexture(this.photo.texture);
    this.photo = { picture, data, texture: photoTexture(this.renderer.gl, picture) };
    this.moved();
  }

  /** Draw all samples now. */
  finish() {
    cancelAnimationFrame(this.asked);
    this.coarse = false;
    while (this.panes.rest());
  }

  async save() {
    this.finish();
    const blob = await new Promise((done) => { this.canvas.toBlob(done, "image/png"); });
    if (blob instanceof Blob) handOut(blob, "seat.png");
  }

  async copyCommand() {
    const own = this.scene.own || this.photo !== null;
    await this.copy(commandOf(this.scene), ` Run it in the folder of ${this.scene.content.files[0]}.${
      own ? " It takes light and material as they were: \"Copy as TOML\" has yours." : ""}`);
  }

  /**
   * Show a text and copy it, where the browser allows that.
   * @param {string} text
   * @param {string} more to be said of it
   */
  async copy(text, more) {
    const area = element("text", HTMLTextAreaElement);
    area.hidden = false;
    area.value = text;
    try {
      await navigator.clipboard.writeText(text);
      box("kept").textContent = `Copied.${more}`;
    } catch {
      area.select();
      box("kept").textContent = `Selected: press Ctrl+C.${more}`;
    }
  }

  send() {
    this.finish();
    const choice = {
      ...this.scene.choice(),
      photo: this.photo ? { data: this.photo.data, width: Number(input("photo-size").value) } : null,
    };
    const page = pageOf(choice, this.room, this.canvas.toDataURL("image/png"));
    handOut(new Blob([page], { type: "text/html" }), "seat.html");
    box("kept").textContent = "The file seat.html shows this seat in any browser.";
  }

  /** @param {import("./scene.js").Choice} choice */
  async choose(choice) {
    this.scene.choose(choice);
    await this.change(choice.seat);
    await this.pair(choice.beside);
    if (choice.photo) {
      input("photo-size").value = String(choice.photo.width);
      this.lay(await photoOf(choice.photo.data), choice.photo.data);
    }
    this.controls.show();
    this.relook();
  }
}

/** @param {string} why */
function shut(why) {
  box("room").hidden = true;
  box("offer").hidden = true;
  say(why);
}

/** @param {string} room */
async function open(room) {
  const text = document.getElementById("viewer-content")?.textContent ?? "";
  button("open").disabled = true;
  box("room").hidden = false;
  try {
    /** @type {Page} */
    const page = JSON.parse(text);
    const viewer = new Viewer(page, await arraysOf(page.buffers), room);
    const choice = sentChoice();
    if (choice) await viewer.choose(choice);
    box("offer").hidden = true;
    document.getElementById("viewer-sent")?.remove();
    viewer.moved();
    say("");
  } catch (problem) {
    console.info(`viewer: ${problem instanceof Error ? problem.message : problem}`);
    shut("This browser cannot turn the seat: it draws no WebGL 2. The pictures on this page need none.");
  }
}

function start() {
  const section = document.getElementById("viewer");
  if (!section) return;
  const room = section.outerHTML;
  box("offer").hidden = false;
  button("open").addEventListener("click", () => void open(room));
  if (sentChoice()) void open(room);
}

start();
