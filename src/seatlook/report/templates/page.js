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
  const large = { box: get("large"), stage: get("large-stage"), picture: get("large-picture") };
  const folds = window.matchMedia("(max-width: 720px)");

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
    exposures();
    for (const button of all("[data-pick]")) {
      const on = choice[button.dataset.pick].value === button.dataset.image;
      button.setAttribute("aria-pressed", String(on));
    }
    for (const light of all("[data-rig]")) {
      light.setAttribute("aria-pressed", String(get(choice.a.value).dataset.of === light.dataset.rig));
    }
  }
  // Brightness compares at one exposure only; shapes always.
  function exposures() {
    const [a, b] = ["a", "b"].map((side) => get(choice[side].value).dataset);
    const differ = Boolean(a.ev && b.ev) && a.ev !== b.ev;
    get("exposures").hidden = !differ;
    get("exposures").textContent = differ
      ? `A is exposed at EV ${a.ev}, B at EV ${b.ev}: compare their shapes, not their brightness.` : "";
  }
  function pick(side, key) {
    choice[side].value = key;
    show();
  }
  // What is picked under a picture is shown there: the comparison opens over the grid.
  function pickHere(button) {
    pick(button.dataset.pick, button.dataset.image);
    get("here").append(get("comparison"));
    get("bench-here").showModal();
    fit();
  }
  function putBack() {
    get("compare").append(get("comparison"));
    fit();
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
  // The place under ``at`` stays where it is; opened from the whole picture that is its middle.
  function resize(panes, times, at) {
    const [first] = panes;
    const sheets = panes.map((pane) => pane.querySelector(".sheet"));
    const whole = sheets[0].dataset.zoom === undefined;
    const [x, y] = at ?? [first.clientWidth / 2, first.clientHeight / 2];
    const share = at || !whole
      ? [(first.scrollLeft + x) / sheets[0].clientWidth, (first.scrollTop + y) / sheets[0].clientHeight]
      : [0.5, 0.5];
    for (const one of sheets) {
      const fits = times === "fit";
      one.style.width = fits ? "" : `${width * Number(times) / window.devicePixelRatio}px`;
      if (fits) delete one.dataset.zoom; else one.dataset.zoom = times;
    }
    first.scrollTo(share[0] * sheets[0].clientWidth - x, share[1] * sheets[0].clientHeight - y);
  }
  function zoom(at) {
    resize([stage, beside], get("zoom").value, at);
    mark();
    scale();
    follow(stage, beside);
  }
  function fit() {
    get("zoom").value = "fit";
    zoom();
  }
  function step(select, by, act) {
    const index = Math.min(Math.max(select.selectedIndex + by, 0), select.options.length - 1);
    if (index === select.selectedIndex) return false;
    select.selectedIndex = index;
    act();
    return true;
  }
  const enlarge = (by, at) => step(get("zoom"), by, () => zoom(at));
  // A wheel turns in small steps on some mice and pads; below the whole picture the page scrolls.
  const turned = new WeakMap();
  function wheel(event, pane, larger) {
    if (event.ctrlKey || !event.deltaY) return;
    const sum = (turned.get(pane) ?? 0) - event.deltaY;
    const box = pane.getBoundingClientRect();
    const moved = Math.abs(sum) < 60
      || larger(Math.sign(sum), [event.clientX - box.left, event.clientY - box.top]);
    turned.set(pane, Math.abs(sum) < 60 ? sum : 0);
    if (moved || event.deltaY < 0) event.preventDefault();
  }

  // A picture by itself, as large as the window, in the page.
  function showLarge(link) {
    const image = get(link.dataset.large);
    large.picture.src = image.src;
    large.picture.alt = image.alt;
    get("large-name").textContent = image.alt;
    get("large-zoom").value = "fit";
    large.box.showModal();
    zoomLarge();
  }
  const zoomLarge = (at) => resize([large.stage], get("large-zoom").value, at);
  const enlargeLarge = (by, at) => step(get("large-zoom"), by, () => zoomLarge(at));

  let last = -1;
  let place = null;
  function mark() {
    const times = sheet.clientWidth / width;
    for (const spot of all(".spot")) {
      spot.hidden = !place;
      if (place) [spot.style.left, spot.style.top] = place.map((v) => `${v * times}px`);
    }
  }
  function jump(button) {
    last = jumps.indexOf(button);
    place = [Number(button.dataset.x), Number(button.dataset.y)];
    unfold(get("compare"));
    get("zoom").value = "2";
    zoom();
    const times = sheet.clientWidth / width;
    stage.scrollTo(place[0] * times - stage.clientWidth / 2, place[1] * times - stage.clientHeight / 2);
    if (!get("bench-here").open) get("compare").scrollIntoView();
    stage.focus();
  }

  const jumps = all("[data-x]");
  const nextJump = () => { if (jumps.length) jump(jumps[(last + 1) % jumps.length]); };

  // Dragging moves the border near it, and the picture elsewhere.
  let held = null;
  function press(event, pane) {
    if (event.button !== 0 || event.pointerType === "touch") return;
    const box = sheet.getBoundingClientRect();
    const away = Math.abs(event.clientX - box.left - box.width * cut.value / 100);
    const near = pane !== large.stage && cuts()
      && (sheet.dataset.zoom === undefined || sheet.dataset.mode === "wipe" && away <= 24);
    held = { pane, pans: !near, x: event.clientX, y: event.clientY, left: pane.scrollLeft, top: pane.scrollTop };
    drag(event);
  }
  function drag(event) {
    if (!held || event.buttons !== 1) return;
    if (held.pans) {
      held.pane.scrollTo(held.left + held.x - event.clientX, held.top + held.y - event.clientY);
    } else {
      const box = sheet.getBoundingClientRect();
      cut.value = String(Math.round(100 * (event.clientX - box.left) / box.width));
      move();
    }
  }

  // In a narrow window sections are folded, and their heads unfold them.
  function foldable(section) {
    const head = section.querySelector("h2");
    const button = document.createElement("button");
    button.type = "button";
    button.className = "fold";
    button.textContent = head.textContent;
    button.setAttribute("aria-expanded", "false");
    const plain = document.createElement("span");
    plain.className = "plain";
    plain.append(...head.childNodes);
    head.append(button, plain);
    section.dataset.folded = "yes";
    button.addEventListener("click", () => unfold(section, section.dataset.folded !== "yes"));
  }
  function unfold(section, shut = false) {
    const button = section.querySelector("h2 > .fold");
    if (!button) return;
    if (shut) section.dataset.folded = "yes"; else delete section.dataset.folded;
    button.setAttribute("aria-expanded", String(!shut));
    if (folds.matches) scale();
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
    button.addEventListener("click", () => pickHere(button));
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
  for (const link of all("[data-large]")) {
    link.addEventListener("click", (event) => {
      if (event.ctrlKey || event.metaKey || event.shiftKey) return;
      event.preventDefault();
      showLarge(link);
    });
  }
  for (const section of all("main > section[id]").slice(1)) foldable(section);
  for (const link of all("nav a")) {
    link.addEventListener("click", () => unfold(document.querySelector(link.hash)));
  }
  if (location.hash) unfold(document.querySelector(location.hash) ?? document.body);
  get("bench-here").addEventListener("close", putBack);
  get("large-zoom").addEventListener("change", () => zoomLarge());
  large.stage.addEventListener("wheel", (event) => wheel(event, large.stage, enlargeLarge), { passive: false });
  for (const button of all("[data-copy]")) button.addEventListener("click", () => copy(button));
  for (const part of all(".scripted")) part.hidden = false;
  cut.addEventListener("input", move);
  get("mode").addEventListener("change", mode);
  get("zoom").addEventListener("change", () => zoom());
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
    pane.addEventListener("scroll", () => follow(pane, other));
    pane.addEventListener("wheel", (event) => wheel(event, pane, enlarge), { passive: false });
  }
  for (const pane of [stage, beside, large.stage]) {
    pane.addEventListener("pointerdown", (event) => press(event, pane));
    pane.addEventListener("pointermove", drag);
    pane.addEventListener("dragstart", (event) => event.preventDefault());
  }
  window.addEventListener("pointerup", () => { held = null; });
  window.addEventListener("resize", () => { mark(); scale(); });

  const keys = {
    f: () => flip(sheet.dataset.flip !== "b"),
    s: swap,
    m: nextMode,
    n: nextJump,
    t: turn,
    "+": () => enlarge(1),
    "-": () => enlarge(-1),
    1: () => { get("zoom").value = "1"; zoom(); },
    0: fit,
    "?": () => get("keys").showModal(),
  };
  const holds = (event) => event.key === " " && [stage, beside, get("hold")].includes(event.target);
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    if (holds(event)) {
      event.preventDefault();
      flip(true);
    }
    if (large.box.open) {
      if ("+-".includes(event.key)) enlargeLarge(event.key === "+" ? 1 : -1);
      return;
    }
    if (!get("keys").open) keys[event.key.toLowerCase()]?.();
  });
  document.addEventListener("keyup", (event) => { if (holds(event)) flip(false); });

  get("comparison").hidden = false;
  large.picture.src = source(choice.a.value);
  mode();
  zoom();
  show();
})();
