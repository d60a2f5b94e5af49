// The task that the address names: how it stands or how it ended, and the tree of one that has ended.

import { apply, onChange } from "./live.js";

const { words, language } = window.arboledaPage;
let named = null; // its id
let state = null; // that it had when its face came
let heard = 0; // how many answers it had then
let asked = 0;

export function start() {
  onChange((patch) => {
    const row = named && patch[`row/tasks/${named}`];
    if (row && (row.state !== state || row.heard !== heard)) ask();
  });
}

export function show(id) {
  document.getElementById("task").hidden = !id;
  if (id === named) return;
  [named, state] = [id, null];
  if (id) ask();
}

async function ask() {
  const number = ++asked;
  const told = await fetched(named).catch(() => null);
  if (number !== asked) return;
  state = told?.["text/task.state"][1] ?? null;
  heard = told?.["rows/task.heard"].length ?? 0;
  apply(told ?? { "text/task.note": [words.task_unheard, ""] });
}

async function fetched(id) {
  const answer = await fetch(`/task.json?${new URLSearchParams({ id, lang: language })}`);
  return answer.ok ? answer.json() : null;
}
