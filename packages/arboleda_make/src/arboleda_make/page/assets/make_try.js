// Try: a task of the draft is simulated in a process of its own, with a fault or without, and looked at as a record.

import { onCells } from "./make_cells.js";
import { ask, begun, box, draft, fill, isRecent, options, spoken } from "./make_state.js";
import { words } from "../shell.js";

const LOOK_MS = 400;
const says = (sentence) => (box("try-state").textContent = sentence);
let last = null; // what came of the last try
let judged = null; // in words, and whether the draft is broken by it

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  box("try_recipe").addEventListener("change", example);
  box("fault").addEventListener("change", about);
  onCells(offer);
}

function offer() {
  const rows = draft.cells.flatMap(({ name: cell, recipes }) => recipes.map(({ name, example }) => [`${cell} ${name}`, `${cell}: ${name}`, example]));
  const before = box("try_recipe").value;
  options(box("try_recipe"), rows, draft.latest ?? before);
  if (box("try_recipe").value === draft.latest) draft.latest = null;
  if (box("try_recipe").value !== before || !box("task").value) example();
}

function example() {
  const found = draft.cells.flatMap(({ name: cell, recipes }) => recipes.map((each) => ({ key: `${cell} ${each.name}`, ...each }))).find(({ key }) => key === box("try_recipe").value);
  box("task").value = found?.example ?? "";
}

function clicked({ target }) {
  const act = target.closest("button")?.dataset.make;
  if (act === "try") go({ task: box("task").value.trim() });
  if (act === "try_fault" && last) go({ task: box("task").value.trim(), faults: [{ ...bare(last.possible[Number(box("fault").value)]), at: Number(box("instant").value) }] });
}

const bare = ({ kind, at, seconds, target, amount, word }) => ({ kind, at, seconds, target, amount, word });

// What this browser tab has tried is there again after it was looked at as a record.
export async function recall() {
  if (last || !isRecent("try")) return;
  const run = await ask("/api/make/runs/try", undefined, () => {});
  if (last || run?.state !== "done") return;
  last = await spoken(await ask("/api/make/runs/try/result", undefined, () => {}));
  if (last) shown(last);
}

// What the last try says of the draft as it is now; null where nothing was tried since it changed.
export const verdict = () => (isRecent("try") ? judged : null);

// Play a story: a task with what befell it, from a proof.
export const play = (wanted) => go({ task: wanted.task, answers: wanted.answers ?? {}, faults: (wanted.faults ?? []).map(bare) });

async function go(wanted) {
  judged = null;
  box("tried").hidden = true;
  says(words.make_trying), begun("try");
  if (!(await ask("/api/make/runs/try", wanted, says))) return false;
  const found = await ended("try", () => {}, says);
  if (found) last = found, shown(found);
  return found !== null;
}

// Wait until a run has ended; its result, or null where the sentence says why there is none.
export async function ended(what, progress, says) {
  for (;;) {
    await new Promise((go) => setTimeout(go, LOOK_MS));
    const run = await spoken(await ask(`/api/make/runs/${what}`, undefined, says));
    if (!run) return null;
    if (run.state === "done") return spoken(await ask(`/api/make/runs/${what}/result`, undefined, says));
    if (run.state !== "running") return says(run.sentence ?? words.make_stopped), null;
    progress(run);
  }
}

function shown({ task, outcome, why, faults, instants, possible }) {
  const befell = faults.map(({ title, target }) => `${target}: ${title}`).join(", ");
  const how = [outcome.end, outcome.cause].filter(Boolean).join(": ");
  const untrue = outcome.untrue.length ? ` ${fill(words.make_unnoticed, { what: outcome.untrue.join("; ") })}` : "";
  const broken = outcome.broken ? ` ${outcome.broken[1]}` : "";
  const text = `${task}${befell ? ` + ${befell}` : ""}: ${how}${why ? ` (${why})` : ""}${untrue}${broken}`;
  says(text);
  judged = { text, isBroken: Boolean(broken || untrue || (!befell && outcome.end !== "done")) };
  box("tried").hidden = false;
  box("fault-form").hidden = !possible.length;
  const chosen = box("fault").value;
  options(box("fault"), possible.map(({ title, target }, n) => [`${n}`, `${target}: ${title}`]), chosen);
  options(box("instant"), instants.map(({ at, name }) => [`${at}`, name]));
  about();
}

const about = () => (box("fault-about").textContent = last?.possible[Number(box("fault").value)]?.about ?? "");
