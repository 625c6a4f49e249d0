// Rules for the viewer's script; types are checked by tsc.
import js from "@eslint/js";

const browser = [
  "atob", "Blob", "cancelAnimationFrame", "console", "createImageBitmap", "DecompressionStream", "document",
  "HTMLButtonElement", "HTMLCanvasElement", "HTMLElement", "HTMLInputElement", "HTMLOutputElement",
  "HTMLSelectElement", "HTMLTextAreaElement", "navigator", "Option", "performance", "requestAnimationFrame",
  "ResizeObserver", "Response", "setTimeout", "SVGCircleElement", "SVGSVGElement", "URL", "window",
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
