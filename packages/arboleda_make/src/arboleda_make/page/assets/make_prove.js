// Prove: `arboleda prove` on the draft in a process of its own: how far it is, what came of it, and checks to add.

import { onCells } from "./make_cells.js";
import { ask, begun, box, draft, element, fill, isRecent, options, step } from "./make_state.js";
import { ended, play } from "./make_try.js";
import { words } from "../shell.js";

const ENDS = ["done", "recovered", "held", "failed"];
const says = (sentence) => (box("prove-state").textContent = sentence);
let found = null;
let isFollowed = false;

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  onCells(offer);
}

function offer() {
  const names = [...new Set(draft.cells.flatMap(({ recipes }) => recipes.map(({ name }) => name)))];
  options(box("prove_recipe"), [["", words.make_what_differs], ...names.map((name) => [name])]);
  options(box("prove_kind"), [["", words.make_everything], ...draft.faults.map(({ name, title }) => [name, title])]);
}

// The recipes that are others than at work: those whose file differs; all, where the plant file has more than another
// use of files and targets that no recipe had before.
const HARMLESS = /^(uses: |[^:,]+\.xml\b|cell [^,]+, target [^:]+: new, )/;

function differing() {
  const recipes = draft.cells.flatMap(({ recipes }) => recipes);
  const isOf = (file) => (line) => line.startsWith(`${file}:`) || line.startsWith(`${file},`);
  const changed = recipes.filter(({ file }) => file && draft.state.changes.some(isOf(file)));
  return draft.state.changes.every((line) => HARMLESS.test(line)) ? [...new Set(changed.map(({ name }) => name))] : [];
}

function clicked({ target }) {
  const { make: act, playStory, findCheck } = target.closest("button")?.dataset ?? {};
  if (act === "prove") prove();
  if (act === "prove_end") ask("/api/make/runs/prove/end", {}, says);
  if (playStory) story(JSON.parse(playStory));
  if (findCheck) notice(target.closest("li"), JSON.parse(findCheck));
}

async function prove() {
  const chosen = box("prove_recipe").value;
  const recipes = chosen ? [chosen] : differing();
  isFollowed = true;
  found = null;
  begun("prove");
  box("proof").replaceChildren();
  says(words.make_proving);
  if (!(await ask("/api/make/runs/prove", { recipes, kinds: [box("prove_kind").value].filter(Boolean), budget_s: Number(box("budget").value) }, says))) return;
  await follow();
}

async function follow() {
  const progress = box("progress");
  progress.hidden = false;
  found = await ended("prove", how, says);
  progress.hidden = true;
  if (found) drawn();
}

// A proof that this browser tab has begun is there again after a story of it was looked at as a record.
export async function recall() {
  if (isFollowed || !isRecent("prove")) return;
  isFollowed = true;
  const run = await ask("/api/make/runs/prove", undefined, () => {});
  if (["running", "done"].includes(run?.state)) await follow();
}

// What the last proof says of the draft as it is now; null where nothing was proved since it changed.
export const verdict = () => (found && isRecent("prove") ? { text: verdictText(), isBroken: isBroken() } : null);

const isBroken = () => found.breaches.length + found.unsound.length > 0;

function verdictText() {
  const { runs, breaches, unsound } = found;
  const verdict = isBroken() ? words.make_broken : runs.done < runs.of ? words.make_sampled : words.make_held;
  return fill(verdict, { done: runs.done, of: runs.of, breaches: breaches.length + unsound.length });
}

function how({ doing, done, total }) {
  const progress = box("progress");
  if (total) (progress.max = total), (progress.value = done ?? 0);
  else progress.removeAttribute("value");
  if (doing) says(fill(words.make_progress, { doing, done: done ?? 0, total: total ?? "?" }));
}

function drawn() {
  const { breaches, unsound, unnoticed, table } = found;
  says(verdictText());
  const link = element("a", words.make_whole_proof, { href: "/proof", target: "_blank", rel: "noopener", class: "act" });
  const parts = [
    ...section(words.make_nobody_notices, unnoticed.map(unnoticedRow)),
    ...section(words.make_breaches, breaches.map(breachRow)),
    ...section(words.make_without_faults, unsound.map(({ task, without_faults: { end, cause, broken } }) => element("li", `${task}: ${broken ? broken[1] : `${end} ${cause}`}`))),
    ...table.map(tableOf),
    link,
  ];
  box("proof").replaceChildren(...parts);
}

function section(title, items) {
  if (!items.length) return [];
  const list = element("ul", "", { class: "make-lines" });
  list.append(...items);
  return [element("h3", title), list];
}

function unnoticedRow(row) {
  const { task, fault, outcome, instant, runs } = row;
  const made = element("li", `${task}: ${named(fault)}: ${outcome.untrue.join("; ")} (${runs}; ${instant}) `);
  made.append(about(fault), storyButton(row), " ", button(words.make_find_check, { findCheck: JSON.stringify(wanted(row)) }));
  return made;
}

function breachRow(row) {
  const made = element("li", `${row.task}: ${named(row.fault)}: ${row.seen} (${row.runs}; ${row.instant}) `);
  made.append(about(row.fault), storyButton(row));
  return made;
}

// A fault by its name, and what it is in words.
const titleOf = (kind) => draft.faults.find(({ name }) => name === kind)?.title ?? kind;
const named = ({ kind, target }) => `${target}: ${titleOf(kind)}`;
const about = ({ kind }) => element("p", draft.faults.find(({ name }) => name === kind)?.about ?? "", { class: "hint" });

const storyButton = (row) => button(words.make_play, { playStory: JSON.stringify(wanted(row)) });

function wanted({ task, answers, fault, then }) {
  const faults = [fault, ...(then ? [then] : [])].map(({ kind, at, seconds, target, amount, word }) => ({ kind, at, seconds, target, amount, word }));
  return { task, answers, faults };
}

function button(text, data) {
  const made = element("button", text, { type: "button", class: "act" });
  Object.assign(made.dataset, data);
  return made;
}

// The story is played in *Try*, where what is to be looked at stands.
async function story(told) {
  document.querySelector('[data-make-panel="try"]').click();
  await play(told);
}

// Look for a check that notices this, and offer to add it.
async function notice(row, told) {
  const line = row.querySelector(".make-check") ?? row.appendChild(element("p", "", { class: "make-check", role: "status" }));
  const tell = (sentence) => (line.textContent = sentence);
  tell(words.make_looking);
  if (!(await ask("/api/make/runs/notice", told, tell))) return;
  const answer = await ended("notice", ({ sentence, done }) => sentence && tell(`${words.make_looking} ${sentence} (${done})`), tell);
  if (!answer) return;
  if (!answer.text) return tell(fill(words.make_no_check, { tried: answer.tried }));
  const { role, fact, value } = answer.check;
  tell(fill(words.make_check, { role, fact, value, end: answer.outcome.end }) + " ");
  const add = button(words.make_add_check, {});
  add.addEventListener("click", async () => {
    if (await step("set_trees", { file: answer.file, text: answer.text })) tell(words.make_check_added);
  });
  line.append(add);
}

export function tableOf({ cell, recipe, faults }) {
  const made = element("table", "", { class: "make-table" });
  made.append(element("caption", `${cell}: ${recipe}`));
  const head = element("tr");
  const columns = ["fault", "runs", ...ENDS, "unnoticed", "broken"];
  head.append(...columns.map((each) => element("th", words[`make_column_${each}`], { scope: "col" })));
  made.append(head);
  for (const [kind, row] of Object.entries(faults)) {
    const line = element("tr");
    line.append(element("th", titleOf(kind), { scope: "row" }));
    line.append(...[row.runs, ...ENDS.map((end) => row.ends[end] ?? 0), row.unnoticed, row.broken].map((each) => element("td", each ? `${each}` : "")));
    made.append(line);
  }
  const around = element("div", "", { class: "make-scroll", tabindex: "0", role: "region", "aria-label": `${cell}: ${recipe}` });
  around.append(made);
  return around;
}
