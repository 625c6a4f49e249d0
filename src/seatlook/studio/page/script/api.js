// Requests to the server of this page, and nowhere else.

/** @typedef {import("./types.js").Fault} Fault */

/** An answer that is none of what was asked for. */
export class Refusal extends Error {
  /** @param {number} status @param {any} body */
  constructor(status, body) {
    super(wordsOf(status, body));
    this.status = status;
    this.body = body;
  }
}

/** @param {number} status @param {any} body */
function wordsOf(status, body) {
  /** @type {Fault[]} */
  const errors = body?.errors ?? [];
  if (errors.length) return errors.map(({ file, line, text }) => [file, line, text].filter(Boolean).join(": ")).join(" ");
  return body?.reason ?? `the server answered ${status}`;
}

/** @param {Response} response */
async function answerOf(response) {
  const text = await response.text();
  let body;
  try {
    body = text ? JSON.parse(text) : {};
  } catch {
    body = { reason: text.slice(0, 300) };
  }
  if (!response.ok) throw new Refusal(response.status, body);
  return body;
}

/** @param {string} path */
export async function ask(path) {
  return answerOf(await fetch(path, { headers: { Accept: "application/json" } }));
}

/** @param {string} path @param {unknown} body */
export async function tell(path, body) {
  return answerOf(await fetch(path, {
    method: "POST", headers: { "Content-Type": "application/json", "X-Seatlook": "1" }, body: JSON.stringify(body),
  }));
}

/** @param {File} file @returns {Promise<{path: string}>} */
export async function upload(file) {
  return answerOf(await fetch(`/api/upload?name=${encodeURIComponent(file.name)}`, {
    method: "POST", headers: { "Content-Type": "application/octet-stream", "X-Seatlook": "1" }, body: file,
  }));
}
