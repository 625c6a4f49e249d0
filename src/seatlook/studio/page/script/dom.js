// Elements of the page, made and found.

/** @typedef {string | number | boolean | null | undefined | ((event: any) => void)} Attribute */
/** @typedef {Node | string | null | undefined | false} Child */

const SVG = "http://www.w3.org/2000/svg";

/**
 * @param {Element} element
 * @param {Record<string, Attribute>} attributes a function listens to the event of its name
 * @param {Child[]} children
 */
function dress(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
  for (const child of children) if (child) element.append(child);
}

/**
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, Attribute>} [attributes]
 * @param {...Child} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  dress(element, attributes, children);
  return element;
}

/**
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} tag
 * @param {Record<string, Attribute>} [attributes]
 * @param {...Child} children
 * @returns {SVGElementTagNameMap[K]}
 */
export function draw(tag, attributes = {}, ...children) {
  const element = /** @type {SVGElementTagNameMap[K]} */ (document.createElementNS(SVG, tag));
  dress(element, attributes, children);
  return element;
}

/**
 * @template {Element} T
 * @param {string} id
 * @param {new () => T} type
 * @returns {T}
 */
export function find(id, type) {
  const element = document.getElementById(id);
  if (!(element instanceof type)) throw new Error(`the page has no ${id}`);
  return element;
}

/** @param {string} id */
export const part = (id) => find(id, HTMLElement);

/**
 * Put new children into an element; what had the focus has it again if it is there again.
 * @param {Element} into
 * @param {...Child} children
 */
export function put(into, ...children) {
  const active = document.activeElement;
  const key = active && into.contains(active) ? active.getAttribute("data-key") : null;
  const scroll = into.scrollTop;
  into.replaceChildren(...children.filter((child) => child !== null && child !== undefined && child !== false));
  into.scrollTop = scroll;
  if (key === null) return;
  const again = [...into.querySelectorAll("[data-key]")].find((one) => one.getAttribute("data-key") === key);
  if (again instanceof HTMLElement) again.focus({ preventScroll: true });
}

/**
 * @param {string} text
 * @param {() => void} act
 * @param {Record<string, Attribute>} [more]
 */
export function press(text, act, more = {}) {
  return make("button", { type: "button", click: act, ...more }, text);
}

/**
 * A number with its name; it tells what was typed when that is a number in its range.
 * @param {string} name
 * @param {number} value
 * @param {(value: number) => void} changed
 * @param {Record<string, Attribute>} more min, max, step and a key
 */
export function numberField(name, value, changed, more = {}) {
  const input = make("input", { type: "number", step: "any", ...more });
  input.value = String(Number(value.toPrecision(6)));
  input.addEventListener("change", () => {
    if (input.value !== "" && input.checkValidity()) changed(Number(input.value));
    else input.reportValidity();
  });
  return make("label", { class: "field" }, make("span", {}, name), input);
}

/**
 * @param {string} name
 * @param {string} value
 * @param {{value: string, text: string}[]} choices
 * @param {(value: string) => void} changed
 * @param {Record<string, Attribute>} [more]
 */
export function choiceField(name, value, choices, changed, more = {}) {
  const select = make("select", more);
  for (const choice of choices) select.add(new Option(choice.text, choice.value));
  if (!choices.some((choice) => choice.value === value)) select.add(new Option(value || "not said", value), 0);
  select.value = value;
  select.addEventListener("change", () => changed(select.value));
  return make("label", { class: "field" }, make("span", {}, name), select);
}

/**
 * @param {string} name
 * @param {string} value
 * @param {(value: string) => void} changed
 * @param {Record<string, Attribute>} [more]
 */
export function textField(name, value, changed, more = {}) {
  const input = make("input", { type: "text", ...more });
  input.value = value;
  input.addEventListener("change", () => {
    if (input.value.trim()) changed(input.value.trim());
  });
  return make("label", { class: "field" }, make("span", {}, name), input);
}
