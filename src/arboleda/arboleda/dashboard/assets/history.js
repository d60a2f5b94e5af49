// The tasks that the plant has kept: the last ones, those that a search finds, and those before them.

import { apply, onChange, value } from "./live.js";

const { language } = window.arboledaPage;
const PAGE = 20;
const ENDED = new Set(["done", "failed", "cancelled"]);
const ended = new Set();
let numbers = [];
let asked = 0;

const box = () => document.getElementById("history-words");
const more = () => document.getElementById("history-more");

export function start() {
  box().addEventListener("input", show);
  more().addEventListener("click", () => ask(numbers.at(-1)));
  onChange((patch) => {
    const paged = numbers.length > PAGE; // who reads older ones keeps them
    if (news(patch) && !paged && !document.getElementById("part-tasks").hidden) show();
  });
}

export const show = () => ask(null);

// A task that has ended, or that came, is in the history at once.
function news(patch) {
  if (!patch["rows/tasks"]) return false;
  const over = patch["rows/tasks"].filter((id) => ENDED.has(value(`row/tasks/${id}`)?.state));
  const isNew = over.some((id) => !ended.has(id));
  over.forEach((id) => ended.add(id));
  return isNew;
}

async function ask(before) {
  const number = ++asked;
  const query = new URLSearchParams({ words: box().value.trim(), lang: language, limit: PAGE });
  if (before) query.set("before", before);
  const answer = await fetch(`/history.json?${query}`).catch(() => null);
  const rows = answer?.ok ? await answer.json() : null;
  if (number !== asked || !rows) return;
  const found = Object.keys(rows).map((key) => Number(key.split("/")[2]));
  found.sort((one, other) => other - one);
  numbers = before ? [...numbers, ...found] : found;
  more().hidden = found.length < PAGE;
  apply({ ...rows, "rows/history": numbers.map(String) });
}
