/** The studio's page: what the folder holds. */

/** Say in one sentence what the server found. */
async function start() {
  const status = document.getElementById("status");
  const answer = await fetch("/api/state");
  const state = await answer.json();
  status.textContent = answer.ok
    ? `${state.name}: ${state.pattern.panels.length} panels, ${state.seams.length} seams`
    : state.errors.map((one) => one.text).join("; ");
}

start();
