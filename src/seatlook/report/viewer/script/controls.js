// Controls beside the seat: each says what is shown, and changes it.

import { hexOf, fromHex, fromLab, labOf } from "./colour.js";
import { box, element, input, offer, say, select } from "./page.js";

/** @typedef {import("./scene.js").Scene} Scene */

const DEGREE = Math.PI / 180;
const RADIUS = 90;

/** @param {string} name @param {string} text */
function output(name, text) {
  element(`${name}-said`, HTMLOutputElement).textContent = text;
}

export class Controls {
  /**
   * @param {Scene} scene
   * @param {number[]} middle of the seat
   * @param {{moved: () => void, look: () => void, photo: (file: File) => void, resized: () => void,
   *   fly: (wrinkle: number) => void, seat: (number: number) => void, beside: (number: number) => void}} tell
   * @param {Partial<import("./drawing/payload.js").Content>[]} others seats beside the first
   */
  constructor(scene, middle, tell, others) {
    this.scene = scene;
    this.middle = middle;
    this.tell = tell;
    this.populate(others);
    this.lightControls();
    this.materialControls();
    this.dial();
    this.show();
  }

  /** @param {Partial<import("./drawing/payload.js").Content>[]} others */
  populate(others) {
    const { content } = this.scene;
    offer(select("rig"), content.rigs.map(({ name }, value) => ({ value, text: name })));
    offer(select("look"), content.looks.map(({ words }, value) => ({ value, text: words })));
    offer(select("layer"), content.maps.map(({ name }, value) => ({ value, text: name })));
    const names = [content.name, ...others.map(({ name }) => name ?? "")];
    offer(select("seat"), names.map((text, value) => ({ value, text })));
    offer(select("beside"), names.map((text, value) => ({ value, text })));
    for (const name of ["seat-label", "beside-label"]) box(name).hidden = others.length === 0;
    select("seat").addEventListener("change", () => this.tell.seat(Number(select("seat").value)));
    select("beside").addEventListener("change", () => this.tell.beside(Number(select("beside").value)));
    this.offerWrinkles();
    for (const view of content.views) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = view.name.replace("_", " ");
      button.addEventListener("click", () => {
        this.scene.view(view);
        this.tell.moved();
      });
      box("views").append(button);
    }
    select("layer").addEventListener("change", () => {
      this.scene.layer = Number(select("layer").value);
      this.changed();
    });
    select("wrinkle").addEventListener("change", () => {
      if (select("wrinkle").value !== "") this.tell.fly(Number(select("wrinkle").value));
    });
  }

  /** Those of the seat that is shown. */
  offerWrinkles() {
    const { wrinkles } = this.scene.content;
    select("wrinkle").length = 1;
    offer(select("wrinkle"), wrinkles.map(({ label }, value) => ({ value, text: label })));
    box("wrinkle-label").hidden = wrinkles.length === 0;
  }

  lightControls() {
    select("rig").addEventListener("change", () => {
      Object.assign(this.scene, { rigNumber: Number(select("rig").value), place: null, power: 0 });
      this.changed();
    });
    for (const name of ["elevation", "azimuth", "distance"]) {
      input(name).addEventListener("input", () => {
        const place = this.scene.lightPlace(this.middle);
        const value = Number(input(name).value);
        this.scene.place = { ...place, [name]: name === "distance" ? value : value * DEGREE };
        this.changed();
      });
    }
    input("power").addEventListener("input", () => {
      this.scene.power = Number(input("power").value);
      this.changed();
    });
    input("follow").addEventListener("change", () => {
      this.scene.follow = input("follow").checked;
      this.changed();
    });
  }

  materialControls() {
    const { scene } = this;
    select("look").addEventListener("change", () => {
      scene.lookNumber = Number(select("look").value);
      scene.changes = {};
      this.relook();
    });
    /** @type {Array<[string, (text: string) => number[] | null]>} */
    const colours = [["colour", fromHex], ["hex", fromHex], ["lab", fromLab]];
    for (const [name, read] of colours) {
      input(name).addEventListener(name === "colour" ? "input" : "change", () => {
        const albedo = read(input(name).value);
        if (!albedo) {
          say(name === "lab" ? "Lab is three numbers, L, a, b, of a colour that a display can show."
            : "A colour in hex is # and six digits or letters a to f.");
          input(name).setAttribute("aria-invalid", "true");
          return;
        }
        scene.changes.albedo = albedo;
        this.relook();
      });
    }
    input("roughness").addEventListener("input", () => {
      scene.changes.roughness = Number(input("roughness").value);
      this.relook();
    });
    input("nap").addEventListener("input", () => {
      scene.changes.nap = Number(input("nap").value);
      this.relook();
    });
    input("photo").addEventListener("change", () => {
      const file = input("photo").files?.[0];
      if (file) this.tell.photo(file);
    });
    input("photo-size").addEventListener("input", () => this.tell.resized());
  }

  /** The dot on the dial goes where it is dragged: the middle is straight above. */
  dial() {
    const dial = element("dial", SVGSVGElement);
    const drag = (/** @type {PointerEvent} */ event) => {
      if (!(event.buttons & 1)) return;
      const area = dial.getBoundingClientRect();
      const x = 208 * ((event.clientX - area.left) / area.width - 0.5);
      const y = 208 * ((event.clientY - area.top) / area.height - 0.5);
      this.scene.place = {
        ...this.scene.lightPlace(this.middle),
        azimuth: Math.atan2(x, y), elevation: Math.max(0, RADIUS - Math.hypot(x, y)) * DEGREE,
      };
      this.changed();
    };
    dial.addEventListener("pointerdown", (event) => {
      dial.setPointerCapture(event.pointerId);
      drag(event);
    });
    dial.addEventListener("pointermove", drag);
  }

  changed() {
    this.show();
    this.tell.moved();
  }

  relook() {
    this.show();
    this.tell.look();
  }

  /** Say in every control what is shown. */
  show() {
    select("seat").value = String(this.scene.seatNumber);
    select("beside").value = String(this.scene.besideNumber);
    this.showLight();
    this.showMaterial();
    this.showLayer();
  }

  showLight() {
    const { scene, middle } = this;
    const place = scene.lightPlace(middle);
    const [first] = scene.rig(middle).lights;
    select("rig").value = String(scene.rigNumber);
    note("rig", noteOf(scene.base));
    const [elevation, azimuth] = [place.elevation, place.azimuth].map((angle) => Math.round(angle / DEGREE));
    input("elevation").value = String(elevation);
    input("azimuth").value = String(azimuth);
    output("elevation", `${elevation}° up`);
    output("azimuth", `${azimuth}°`);
    for (const name of ["elevation", "azimuth", "power"]) input(name).disabled = !first;
    input("power").value = String(scene.power);
    output("power", first ? powerOf(first) : "");
    box("distance-label").hidden = !first?.near;
    input("distance").value = String(place.distance);
    output("distance", `${Math.round(1e3 * place.distance)} mm`);
    input("follow").checked = scene.follow;
    const dot = element("dot", SVGCircleElement);
    const radius = RADIUS - Math.max(0, place.elevation / DEGREE);
    dot.setAttribute("cx", (radius * Math.sin(place.azimuth)).toFixed(1));
    dot.setAttribute("cy", (radius * Math.cos(place.azimuth)).toFixed(1));
  }

  showMaterial() {
    const m = this.scene.main;
    select("look").value = String(this.scene.lookNumber);
    box("look-note").hidden = !this.scene.content.measured.includes(this.scene.lookName);
    for (const name of ["hex", "lab"]) input(name).removeAttribute("aria-invalid");
    input("colour").value = hexOf(m.albedo);
    input("hex").value = hexOf(m.albedo);
    input("lab").value = labOf(m.albedo).map((x) => x.toFixed(1)).join(", ");
    input("roughness").value = String(m.roughness);
    output("roughness", m.roughness.toFixed(2));
    input("nap").value = String(Math.max(...m.sheen));
    output("nap", Math.max(...m.sheen).toFixed(2));
  }

  showLayer() {
    const { scene } = this;
    select("layer").value = String(scene.layer);
    box("legend").hidden = scene.layer < 0;
    if (scene.layer < 0) return;
    const map = scene.content.maps[scene.layer];
    const unit = map.unit === "1" ? "" : ` ${map.unit}`;
    box("low").textContent = `${Number(map.low.toPrecision(3))}${unit}`;
    box("high").textContent = `${Number(map.high.toPrecision(3))}${unit}`;
    box("meaning").textContent = `${map.name}: ${map.meaning}`;
  }
}

/** @param {string} name @param {string} text */
function note(name, text) {
  box(`${name}-note`).textContent = text;
  box(`${name}-note`).hidden = text === "";
}

/** What the viewer does not show of a light as the pictures do. @param {import("./drawing/payload.js").Rig} rig */
function noteOf({ lights, left, panorama }) {
  return [
    left ? `Shown with ${lights.length} of its ${lights.length + left} lamps, so darker than in the pictures.` : "",
    panorama ? "Its sky is a picture; here it is even, as bright." : "",
    lights.length > 1 ? `The dial moves the first of its ${lights.length} lamps or parts.` : "",
  ].filter(Boolean).join(" ");
}

/** Power in the light's own unit. @param {import("./drawing/payload.js").Light} light */
function powerOf(light) {
  const value = light.near ? light.intensity * (light.sides ? Math.PI : 4 * Math.PI) : light.intensity;
  return `${Number(value.toPrecision(3)).toLocaleString("en")} ${light.near ? "lm" : "lx"}`;
}

/**
 * Draw the bar of colours, from their square roots.
 * @param {ArrayLike<number>} colours
 */
export function drawBar(colours) {
  const bar = element("bar", HTMLCanvasElement);
  const context = bar.getContext("2d");
  if (!context) return;
  for (let k = 0; k < 256; ++k) {
    const linear = [0, 1, 2].map((c) => (colours[3 * k + c] / 255) ** 2);
    context.fillStyle = hexOf(linear);
    context.fillRect(k, 0, 1, bar.height);
  }
}
