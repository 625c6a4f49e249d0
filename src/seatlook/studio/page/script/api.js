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

let waiting = 0;

/**
 * Send, and say on the page that an answer is waited for.
 * @param {string} path
 * @param {RequestInit} request
 */
async function send(path, request) {
  waiting += 1;
  document.body.dataset.busy = "yes";
  try {
    return await answerOf(await fetch(path, request));
  } finally {
    waiting -= 1;
    // What follows at once from an answer is waited for as well.
    setTimeout(() => { if (waiting === 0) document.body.dataset.busy = "no"; });
  }
}

/** @param {string} path */
export async function ask(path) {
  return send(path, { headers: { Accept: "application/json" } });
}

/** @param {string} path @param {unknown} body */
export async function tell(path, body) {
  return send(path, {
    method: "POST", headers: { "Content-Type": "application/json", "X-Seatlook": "1" }, body: JSON.stringify(body),
  });
}

/** @param {File} file @returns {Promise<{path: string}>} */
export async function upload(file) {
  return send(`/api/upload?name=${encodeURIComponent(file.name)}`, {
    method: "POST", headers: { "Content-Type": "application/octet-stream", "X-Seatlook": "1" }, body: file,
  });
}
