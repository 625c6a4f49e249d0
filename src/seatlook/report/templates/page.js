"use strict";
(() => {
  const get = (id) => document.getElementById(id);
  const all = (selector) => [...document.querySelectorAll(selector)];
  const sheet = get("sheet");
  const stage = get("stage");
  const beside = get("beside");
  const cut = get("cut");
  const choice = { a: get("choice-a"), b: get("choice-b") };
  const pictures = { a: [get("picture-a")], b: [get("picture-b"), get("picture-beside")] };
  const overlay = { choice: get("overlay"), pictures: all(".over"), opacity: get("opacity") };
  const chosen = (select) => select.selectedOptions[0].textContent;
  const source = (key) => get(key).src;
  const width = Number(pictures.a[0].getAttribute("width"));

  // What is shown.
  function show() {
    for (const [side, images] of Object.entries(pictures)) {
      for (const image of images) {
        image.src = source(choice[side].value);
        image.alt = `${side.toUpperCase()}: ${chosen(choice[side])}`;
      }
    }
    const over = overlay.choice.value;
    overlay.opacity.disabled = !over;
    for (const image of overlay.pictures) {
      image.hidden = !over;
      image.src = source(over || choice.a.value);
      image.alt = over ? `Over it: ${chosen(overlay.choice)}` : "";
      image.style.opacity = `${overlay.opacity.value}%`;
    }
    get("status").textContent = `A: ${chosen(choice.a)}. B: ${chosen(choice.b)}.`
      + (over ? ` Over both: ${chosen(overlay.choice)}.` : "");
    for (const light of all("[data-rig]")) {
      light.setAttribute("aria-pressed", String(get(choice.a.value).dataset.of === light.dataset.rig));
    }
  }
  function pick(side, key) {
    choice[side].value = key;
    show();
  }
  function swap() {
    [choice.a.value, choice.b.value] = [choice.b.value, choice.a.value];
    show();
  }
  function flip(on) {
    sheet.dataset.flip = on ? "b" : "";
    get("flip").setAttribute("aria-pressed", String(on));
  }
  const move = () => sheet.style.setProperty("--cut", `${cut.value}%`);
  const cuts = () => ["wipe", "blend"].includes(sheet.dataset.mode);
  function mode() {
    sheet.dataset.mode = get("mode").value;
    beside.hidden = sheet.dataset.mode !== "side";
    cut.disabled = !cuts();
    move();
    scale();
    follow(stage, beside);
  }
  function nextMode() {
    const select = get("mode");
    select.selectedIndex = (select.selectedIndex + 1) % select.options.length;
    mode();
  }
  // Both panes show the same place.
  const follow = (one, other) => other.scrollTo(one.scrollLeft, one.scrollTop);

  // The same picture of A under another light.
  function light(rig) {
    const now = get(choice.a.value);
    const there = all("[data-of]").filter((image) => image.dataset.of === rig);
    const same = there.find((image) => image.dataset.row === now.dataset.row) ?? there[0];
    pick("a", same.id);
  }

  // Size: one image pixel is one screen pixel at 1:1, whatever the display's scale.
  function scale() {
    const now = pictures.a[0].getBoundingClientRect().width * window.devicePixelRatio / width;
    const seen = Number(get("scale").dataset.density) * now;
    get("scale").textContent = Math.abs(now - 1) < 0.005
      ? "1:1, as scored"
      : `${now.toFixed(2)}:1, ${seen.toFixed(0)} pixels per degree; scores are for 1:1`;
  }
  function zoom() {
    const times = get("zoom").value;
    const fits = times === "fit";
    for (const one of all(".sheet")) {
      one.style.width = fits ? "" : `${width * Number(times) / window.devicePixelRatio}px`;
      if (fits) delete one.dataset.zoom; else one.dataset.zoom = times;
    }
    scale();
  }
  function enlarge(step) {
    const zoomed = get("zoom");
    const index = Math.min(Math.max(zoomed.selectedIndex + step, 0), zoomed.options.length - 1);
    zoomed.selectedIndex = index;
    zoom();
  }
  let last = -1;
  function jump(button) {
    last = jumps.indexOf(button);
    get("zoom").value = "2";
    zoom();
    const times = sheet.clientWidth / width;
    const [x, y] = [Number(button.dataset.x) * times, Number(button.dataset.y) * times];
    for (const spot of all(".spot")) {
      spot.hidden = false;
      spot.style.left = `${x}px`;
      spot.style.top = `${y}px`;
    }
    stage.scrollTo(x - stage.clientWidth / 2, y - stage.clientHeight / 2);
    get("compare").scrollIntoView();
    stage.focus();
  }

  const jumps = all("[data-x]");
  const nextJump = () => { if (jumps.length) jump(jumps[(last + 1) % jumps.length]); };

  // Dragging moves the border near it, and the picture elsewhere.
  let held = null;
  function press(event) {
    if (event.button !== 0 || event.pointerType === "touch") return;
    const box = sheet.getBoundingClientRect();
    const away = Math.abs(event.clientX - box.left - box.width * cut.value / 100);
    const near = cuts() && (sheet.dataset.zoom === undefined || sheet.dataset.mode === "wipe" && away <= 24);
    const pans = !near;
    held = { pans, x: event.clientX, y: event.clientY, left: stage.scrollLeft, top: stage.scrollTop };
    drag(event);
  }
  function drag(event) {
    if (!held || event.buttons !== 1) return;
    if (held.pans) {
      stage.scrollTo(held.left + held.x - event.clientX, held.top + held.y - event.clientY);
    } else {
      const box = sheet.getBoundingClientRect();
      cut.value = String(Math.round(100 * (event.clientX - box.left) / box.width));
      move();
    }
  }

  // Rows become columns and columns rows.
  function turn() {
    const table = document.querySelector(".grid");
    const cells = [...table.rows].map((row) => [...row.cells]);
    const head = document.createElement("thead");
    const body = document.createElement("tbody");
    cells[0].forEach((_, column) => {
      const row = (column ? body : head).insertRow();
      cells.forEach((line, index) => {
        const cell = line[column];
        if (cell.tagName === "TH") cell.scope = column ? "row" : "col";
        if (cell.tagName === "TH" && !column && !index) cell.scope = "col";
        row.append(cell);
      });
    });
    table.replaceChildren(head, body);
    table.dataset.turned = table.dataset.turned === "yes" ? "" : "yes";
    get("turn").setAttribute("aria-pressed", String(table.dataset.turned === "yes"));
  }

  // One range for all maps, or each its own.
  function range() {
    for (const image of all("img[data-alone]")) {
      const own = get(image.dataset.alone);
      image.dataset.shared ??= image.src;
      image.dataset.sharedAlt ??= image.alt;
      image.src = get("shared").checked ? image.dataset.shared : own.src;
      image.alt = get("shared").checked ? image.dataset.sharedAlt : own.alt;
      const label = image.closest("figure").querySelector(".range");
      label.dataset.shared ??= label.textContent;
      label.textContent = get("shared").checked ? label.dataset.shared : label.dataset.alone;
    }
    show();
  }

  async function copy(button) {
    const text = get(button.dataset.copy);
    try {
      await navigator.clipboard.writeText(text.textContent);
      button.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(text);
      button.textContent = "Selected: press Ctrl+C";
    }
  }

  for (const select of [choice.a, choice.b, overlay.choice]) select.addEventListener("change", show);
  overlay.opacity.addEventListener("input", show);
  for (const button of all("[data-pick]")) {
    button.parentElement.hidden = false;
    button.addEventListener("click", () => pick(button.dataset.pick, button.dataset.image));
  }
  for (const mark of all("[data-rig]")) {
    mark.addEventListener("click", () => light(mark.dataset.rig));
    mark.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      light(mark.dataset.rig);
    });
  }
  for (const button of jumps) button.addEventListener("click", () => jump(button));
  for (const button of all("[data-copy]")) button.addEventListener("click", () => copy(button));
  for (const part of all(".scripted")) part.hidden = false;
  cut.addEventListener("input", move);
  get("mode").addEventListener("change", mode);
  get("zoom").addEventListener("change", zoom);
  get("swap").addEventListener("click", swap);
  get("turn").addEventListener("click", turn);
  get("shared")?.addEventListener("change", range);
  get("flip").addEventListener("click", () => flip(sheet.dataset.flip !== "b"));
  get("help").addEventListener("click", () => get("keys").showModal());
  get("hold").addEventListener("pointerdown", () => flip(true));
  for (const end of ["pointerup", "pointerleave", "blur"]) {
    get("hold").addEventListener(end, () => flip(false));
  }
  for (const [pane, other] of [[stage, beside], [beside, stage]]) {
    pane.addEventListener("pointerdown", press);
    pane.addEventListener("pointermove", drag);
    pane.addEventListener("dragstart", (event) => event.preventDefault());
    pane.addEventListener("scroll", () => follow(pane, other));
  }
  window.addEventListener("pointerup", () => { held = null; });
  window.addEventListener("resize", scale);

  const keys = {
    f: () => flip(sheet.dataset.flip !== "b"),
    s: swap,
    m: nextMode,
    n: nextJump,
    t: turn,
    "+": () => enlarge(1),
    "-": () => enlarge(-1),
    1: () => { get("zoom").value = "1"; zoom(); },
    0: () => { get("zoom").value = "fit"; zoom(); },
    "?": () => get("keys").showModal(),
  };
  const holds = (event) => event.key === " " && [stage, beside, get("hold")].includes(event.target);
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (holds(event)) {
      event.preventDefault();
      flip(true);
    }
    if (!get("keys").open) keys[event.key.toLowerCase()]?.();
  });
  document.addEventListener("keyup", (event) => { if (holds(event)) flip(false); });

  get("comparison").hidden = false;
  mode();
  zoom();
  show();
})();
