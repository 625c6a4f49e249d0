"use strict";
(() => {
  const get = (id) => document.getElementById(id);
  const questionnaire = JSON.parse(get("questionnaire").textContent);
  const picture = {};
  for (const s of questionnaire.stimuli) picture[s.name] = s.picture;
  for (const c of questionnaire.catches) for (const s of [c.wrinkled, c.smooth]) picture[s.name] = s.picture;
  const root = `seatlook-jury-${questionnaire.digest}`;
  const memory = {};
  let state = null; // {judge, session, votes} of the judge who sits here
  let shown = 0; // when the pair came into sight [ms]
  let open = false; // whether an answer is awaited

  function notice(text) {
    get("notice").textContent = text;
    get("notice").hidden = !text;
  }
  function read(key) {
    try { return JSON.parse(localStorage.getItem(key)); } catch { return memory[key] ?? null; }
  }
  function store(key, value) {
    memory[key] = value;
    try { localStorage.setItem(key, JSON.stringify(value)); } catch {
      notice("This browser does not store your answers: save them before you close the page.");
    }
  }
  const trials = () => questionnaire.sessions[state.session].trials;
  const own = (session) => `${root}-${session}`;
  function only(...ids) {
    for (const id of ["start", "pause", "trial", "end"]) get(id).hidden = !ids.includes(id);
    get("saving").hidden = !state || state.votes.length === 0;
  }

  function next() {
    open = false;
    const number = state.votes.length;
    if (number >= trials().length) {
      only("end");
      get("save").focus();
      return;
    }
    const question = trials()[number][0];
    const first = number === 0 || trials()[number - 1][0] !== question;
    if (first) pause(question); else show();
  }
  function pause(question) {
    get("pause-question").textContent = questionnaire.questions[question];
    only("pause");
    get("continue").focus();
  }
  async function show() {
    const number = state.votes.length;
    const [question, , left, right] = trials()[number];
    open = false;
    get("question").textContent = questionnaire.questions[question];
    get("status").textContent = `Pair ${number + 1} of ${trials().length}`;
    get("bar").value = number;
    get("back").disabled = number === 0;
    only("trial");
    const images = [["left", left], ["right", right]].map(([side, name]) => {
      const image = get(`picture-${side}`);
      image.classList.add("waiting");
      image.src = picture[name];
      return image;
    });
    try {
      await Promise.all(images.map((image) => image.decode()));
    } catch {
      notice("A picture cannot be shown. Please tell the person who sent you this page.");
      return;
    }
    if (state === null || state.votes.length !== number) return;
    for (const image of images) image.classList.remove("waiting");
    scale();
    shown = performance.now();
    open = true;
    const after = trials()[number + 1];
    if (after) for (const name of after.slice(2)) new Image().src = picture[name];
  }
  function scale() {
    const image = get("picture-left");
    const share = image.clientWidth * window.devicePixelRatio / Number(image.getAttribute("width"));
    get("scale").textContent = Math.abs(share - 1) < 0.02 ? "" :
      `Pictures are shown at ${Math.round(100 * share)} % of their size.`;
  }
  function choose(choice) {
    if (!open) return;
    open = false;
    const number = state.votes.length;
    const [question, , left, right] = trials()[number];
    const seconds = Math.round((performance.now() - shown) / 100) / 10;
    state.votes.push({ trial: number, question, left, right, choice, seconds });
    store(own(state.session), state);
    get("saved").textContent = "";
    next();
  }
  function back() {
    if (get("trial").hidden || state.votes.length === 0) return;
    state.votes.pop();
    store(own(state.session), state);
    show();
  }
  function begin(event) {
    event.preventDefault();
    const judge = get("judge").value.trim();
    const session = Number(get("session").value) - 1;
    if (!judge || !questionnaire.sessions[session]) return;
    const before = read(own(session));
    if (before && before.judge !== judge) {
      notice(`Number ${session + 1} is already used by another judge on this machine. Please take another one.`);
      get("session").focus();
      return;
    }
    notice("");
    state = before ?? { judge, session, votes: [] };
    store(own(session), state);
    store(root, session);
    next();
  }
  function save() {
    const seed = questionnaire.sessions[state.session].seed;
    const answers = { schema: questionnaire.schema, questionnaire: questionnaire.digest, judge: state.judge, seed, votes: state.votes };
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([JSON.stringify(answers, null, 1)], { type: "application/json" }));
    link.download = `votes-${state.judge.replace(/[^\p{L}\p{N}]+/gu, "-")}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    get("saved").textContent = `${state.votes.length} of ${trials().length} answers saved.`;
  }
  function other() {
    store(root, null);
    state = null;
    get("start").reset();
    get("saved").textContent = "";
    only("start");
    get("judge").focus();
  }
  function key(event) {
    if (event.repeat || event.ctrlKey || event.metaKey || event.altKey || get("trial").hidden) return;
    const choice = { ArrowLeft: "left", ArrowRight: "right", ArrowDown: questionnaire.ties ? "tie" : "" }[event.key];
    if (choice) choose(choice);
    else if (event.key === "Backspace") back();
    else return;
    event.preventDefault();
  }

  get("start").addEventListener("submit", begin);
  get("continue").addEventListener("click", show);
  for (const side of ["left", "right", "tie"]) get(side)?.addEventListener("click", () => choose(side));
  get("back").addEventListener("click", back);
  get("save").addEventListener("click", save);
  get("other").addEventListener("click", other);
  document.addEventListener("keydown", key);
  window.addEventListener("resize", scale);

  const session = read(root);
  state = session === null ? null : read(own(session));
  if (state) next(); else other();
})();
