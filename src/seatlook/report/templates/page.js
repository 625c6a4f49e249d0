"use strict";
(() => {
  const get = (id) => document.getElementById(id);
  const sheet = document.querySelector(".sheet");
  const stage = get("stage");
  const cut = get("cut");
  const choice = { a: get("choice-a"), b: get("choice-b") };
  const picture = { a: get("picture-a"), b: get("picture-b") };
  const chosen = (side) => choice[side].selectedOptions[0].textContent;

  function show() {
    for (const side of ["a", "b"]) {
      picture[side].src = choice[side].value;
      picture[side].alt = `${side.toUpperCase()}: ${chosen(side)}`;
    }
    get("said").textContent = `A: ${chosen("a")}. B: ${chosen("b")}.`;
  }
  function pick(side, image) {
    choice[side].value = image;
    show();
  }
  function swap() {
    const a = choice.a.value;
    choice.a.value = choice.b.value;
    choice.b.value = a;
    show();
  }
  function flip(on) {
    sheet.dataset.flip = on ? "b" : "";
    get("flip").setAttribute("aria-pressed", String(on));
  }
  const move = () => sheet.style.setProperty("--cut", `${cut.value}%`);
  function mode() {
    sheet.dataset.mode = get("mode").value;
    cut.disabled = sheet.dataset.mode === "difference";
    move();
  }
  function zoom() {
    const times = get("zoom").value;
    const fits = times === "fit";
    // One image pixel is one screen pixel at 1:1, whatever the display's scale.
    const width = Number(picture.a.getAttribute("width")) * Number(times) / window.devicePixelRatio;
    sheet.style.width = fits ? "" : `${width}px`;
    if (fits) delete sheet.dataset.zoom; else sheet.dataset.zoom = times;
  }
  function drag(event) {
    if (event.buttons !== 1 || sheet.dataset.mode !== "wipe" || event.pointerType === "touch") return;
    const box = sheet.getBoundingClientRect();
    cut.value = String(Math.round(100 * (event.clientX - box.left) / box.width));
    move();
  }

  choice.b.selectedIndex = Math.min(1, choice.b.options.length - 1);
  for (const side of ["a", "b"]) choice[side].addEventListener("change", show);
  for (const button of document.querySelectorAll("[data-pick]")) {
    button.parentElement.hidden = false;
    button.addEventListener("click", () => pick(button.dataset.pick, button.dataset.image));
  }
  cut.addEventListener("input", move);
  get("mode").addEventListener("change", mode);
  get("zoom").addEventListener("change", zoom);
  get("swap").addEventListener("click", swap);
  get("flip").addEventListener("click", () => flip(sheet.dataset.flip !== "b"));
  stage.addEventListener("pointerdown", drag);
  stage.addEventListener("pointermove", drag);
  stage.addEventListener("dragstart", (event) => event.preventDefault());
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (event.key === "f" || event.key === "F") flip(sheet.dataset.flip !== "b");
    if (event.key === "s" || event.key === "S") swap();
  });

  get("comparison").hidden = false;
  mode();
  zoom();
  show();
})();
