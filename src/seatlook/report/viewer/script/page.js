// Elements of the page, by what they are called.

/**
 * @template {Element} T
 * @param {string} name without the "viewer-" before it
 * @param {new () => T} type
 * @returns {T}
 */
export function element(name, type) {
  const found = document.getElementById(`viewer-${name}`);
  if (!(found instanceof type)) throw new Error(`the page has no viewer-${name}`);
  return found;
}

/** @param {string} name */
export const input = (name) => element(name, HTMLInputElement);
/** @param {string} name */
export const select = (name) => element(name, HTMLSelectElement);
/** @param {string} name */
export const button = (name) => element(name, HTMLButtonElement);
/** @param {string} name */
export const box = (name) => element(name, HTMLElement);

/**
 * @param {HTMLSelectElement} into
 * @param {Array<{value: number, text: string}>} choices
 */
export function offer(into, choices) {
  for (const { value, text } of choices) into.add(new Option(text, String(value)));
}

/** @param {string} text */
export function say(text) {
  box("status").textContent = text;
}

/**
 * Hand a file to whoever reads the page.
 * @param {Blob} content
 * @param {string} name
 */
export function handOut(content, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
