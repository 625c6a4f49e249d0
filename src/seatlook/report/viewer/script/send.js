// A new page in one file: this viewer alone, with what has been chosen.

/** @typedef {import("./scene.js").Choice} Choice */

// In one piece it would end the script that it stands in.
const END = ["<", "/script>"].join("");

/** @param {string} text */
const escaped = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

/**
 * What was chosen where the page was sent from, or null.
 * @returns {Choice | null}
 */
export function sentChoice() {
  const found = document.getElementById("viewer-choice");
  return found ? JSON.parse(found.textContent ?? "null") : null;
}

/**
 * Text of the page. Style and script are those of this page, which its content policy admits by
 * their digests.
 * @param {Choice} choice
 * @param {string} room the section as it was before the viewer was opened
 * @param {string} picture address of what is shown, for browsers without WebGL
 */
export function pageOf(choice, room, picture) {
  const text = (/** @type {string} */ selector) => document.querySelector(selector)?.textContent ?? "";
  const policy = document.querySelector("meta[http-equiv]")?.getAttribute("content") ?? "";
  const title = escaped(document.title);
  const json = JSON.stringify(choice).replace(/</g, "\\u003c");
  return `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${escaped(policy)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>${title}</title>
<style>${text("head > style")}</style>
</head>
<body>
<header><h1>${escaped(document.querySelector("h1")?.textContent ?? "")}</h1></header>
<main>
<figure id="viewer-sent"><img src="${picture}" alt="The seat as it was sent"></figure>
${room}
</main>
<script type="application/json" id="viewer-content">${text("#viewer-content")}${END}
<script type="application/json" id="viewer-choice">${json}${END}
<script id="viewer-script">${text("#viewer-script")}${END}
</body>
</html>
`;
}
