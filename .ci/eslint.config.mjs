// Rules for the scripts of viewer and studio; types are checked by tsc.
import js from "@eslint/js";

const browser = [
  "atob", "Blob", "cancelAnimationFrame", "clearTimeout", "console", "createImageBitmap", "DecompressionStream",
  "document", "EventSource", "fetch", "HTMLButtonElement", "HTMLCanvasElement", "HTMLDialogElement", "HTMLElement",
  "HTMLInputElement", "HTMLOutputElement", "HTMLProgressElement", "HTMLSelectElement", "HTMLTextAreaElement",
  "matchMedia", "navigator", "Option", "performance", "requestAnimationFrame", "ResizeObserver", "Response",
  "setTimeout", "SVGCircleElement", "SVGElement", "SVGSVGElement", "URL", "window",
];

export default [
  js.configs.recommended,
  {
    languageOptions: { globals: Object.fromEntries(browser.map((name) => [name, "readonly"])) },
    rules: {
      curly: ["error", "multi-line"], eqeqeq: "error", "no-eval": "error", "no-implied-eval": "error",
      "no-new-func": "error", "no-shadow": "error", "no-var": "error", "prefer-const": "error",
      "max-lines": ["error", 400], "max-params": ["error", 6],
      "max-lines-per-function": ["error", { max: 45, skipBlankLines: true, skipComments: true }],
    },
  },
];
