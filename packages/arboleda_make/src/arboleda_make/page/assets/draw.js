// The editor of trees: a text that the server edits, one operation after the other, and what is shown of it.

import * as acts from "./draw_acts.js";
import * as copies from "./draw_copy.js";
import * as form from "./draw_form.js";
import * as palette from "./draw_palette.js";
import * as rows from "./draw_rows.js";
import { NEW, ask, box, node, say, state, tree } from "./draw_state.js";
import * as make from "./make_state.js";
import * as question from "../question.js";
import { words } from "../shell.js";

let line = Promise.resolve(); // one operation after the other
let behind = false; // whether the draft has gone a step back or forward that is not shown yet

export function start() {
  const part = document.getElementById("draw");
  if (!part) return;
  acts.start(part);
  box("cell").addEventListener("change", ({ target }) => leave(target, state.cell, open));
  box("file").addEventListener("change", ({ target }) => leave(target, state.file, openFile));
  window.addEventListener("beforeunload", (event) => unsaved() && event.preventDefault());
  palette.start();
  rows.start();
  form.start();
  copies.start();
  part.querySelector("[data-to-panel]")?.addEventListener("click", ({ target }) => toTry(target.dataset.toPanel));
  part.querySelector("[data-make=take]")?.addEventListener("click", takeOver);
  make.onDraft(() => state.now && !behind && buttons());
}

// Where the plant has a draft, its trees are drawn: each edit is a step of it. Else a file is made of what is drawn.
const ofDraft = () => make.there() && make.draft.state?.is_ours === true;
const nameOf = (file) => file.replace(/^.*\//, "").replace(/\.xml$/, "");
const treeFiles = async () => (ofDraft() ? make.draft.state?.trees.map((file) => ({ recipe: nameOf(file), file })) : ask("/api/trees"));
const way = (path) => (ofDraft() ? `/api/make/${path}` : `/api/trees/${path.replace("drawn/", "")}`);

// What the server makes of a text, with what is found in it in the language of the page.
async function drawn(act, asked) {
  const shown = await ask(way(`drawn/${act}`), asked);
  return shown && { ...shown, marks: await make.spoken(shown.marks) };
}

// Begin with this cell, where nothing is drawn yet.
export function show(cell) {
  if (!document.getElementById("draw") || state.past.length || (state.now && !cell && !ofDraft())) return;
  const first = cell ?? (state.cell || box("cell").value);
  if (first !== state.cell || ofDraft()) open(first);
}

// What is drawn is what is tried.
function toTry(panel) {
  make.draft.latest = `${state.cell} ${state.file}`;
  make.remember(panel);
}

// Begin with a recipe of the draft.
export function showRecipe(recipe) {
  state.file = recipe;
}

const unsaved = () => !ofDraft() && state.past.length > 0 && state.now.text !== state.saved;

// Open what was chosen instead of a tree with changes that are in no file, if that is meant.
async function leave(select, before, go) {
  const chosen = select.value;
  select.value = before;
  if (!unsaved() || (await question.confirmed(words.draw_leave))) go(chosen);
}

async function open(cell) {
  state.cell = cell;
  box("cell").value = cell;
  const language = window.arboledaPage.language;
  if (make.there()) await make.look();
  const [files, groups] = await Promise.all([treeFiles(), ask(`${way("palette")}?${new URLSearchParams({ cell, language })}`)]);
  if (!files || !groups || state.cell !== cell) return;
  state.files = files.filter(({ cells }) => !cells || cells.includes(cell));
  state.kinds = new Map(groups.flatMap(({ kinds }) => kinds.map((kind) => [kind.name, kind])));
  palette.fill(groups);
  const options = state.files.map(({ recipe, file }) => new Option(file, recipe));
  box("file").replaceChildren(...options, ...(ofDraft() ? [] : [new Option(words.draw_new, "")]));
  box("desk").hidden = ofDraft() && !options.length;
  box("empty").hidden = !box("desk").hidden;
  const same = ofDraft() && state.files.find(({ recipe }) => recipe === state.file);
  await openFile((same || state.files[0])?.recipe ?? "", same ? mine() : {});
  copies.offer(cell, ofDraft());
}

// Copy the recipe in Python that is chosen as a tree, and open that.
export function copyRecipe() {
  return leave(box("file"), box("file").value, () => copies.copy(ofDraft()));
}

// Open a tree that the draft has now.
export function reopened(recipe) {
  state.file = recipe;
  return open(state.cell);
}

// Open a file that is nowhere yet.
export async function opened(file) {
  state.files = [...state.files.filter(({ recipe }) => recipe !== file.recipe), file];
  const option = [...box("file").options].find(({ value }) => value === file.recipe) ?? new Option(file.file, file.recipe);
  box("file").prepend(option);
  await openFile(file.recipe);
  return state.file === file.recipe;
}

async function openFile(recipe, place = {}) {
  const { cell } = state;
  const found = state.files.find((each) => each.recipe === recipe);
  const text = found && (ofDraft() ? (await ask(`/api/draft/trees?${new URLSearchParams({ file: found.file })}`))?.text : found.text);
  const shown = await drawn("check", { cell, text: text ?? NEW });
  if (!shown || state.cell !== cell) return;
  box("file").value = recipe;
  Object.assign(state, { file: recipe, past: [], future: [], now: shown, saved: shown.text, tree: null, path: "root", ...place });
  draw();
}

// Carry out what `make` returns, once all before it is done; `then` says which node is chosen after it.
export function edit(make, then) {
  return next(async () => {
    const { cell, now } = state;
    const operation = now && make();
    const shown = operation && (await drawn("edit", { cell, text: now.text, operation }));
    if (!shown || now !== state.now) return;
    say("");
    const changed = shown.text !== state.now.text;
    if (changed && !ofDraft()) state.past.push({ ...mine(), now: state.now }), (state.future = []);
    state.now = shown;
    Object.assign(state, then?.(shown));
    draw();
    if (changed && ofDraft()) await keep(shown.text);
  });
}

// Have the draft keep the text; where it does not, because somebody else edits, what it has is shown again.
async function keep(text) {
  const file = state.files.find(({ recipe }) => recipe === state.file)?.file;
  if (!file) return say(words.draw_no_recipe);
  if (await make.step("set_trees", { file, text })) return;
  await make.look();
  await reload();
}

// Whoever takes over goes on with what the draft has by then.
const takeOver = () => next(async () => (await make.take()) && state.now && (await reload()));

// Show the tree that the draft has now.
async function reload() {
  state.files = (await treeFiles()) ?? [];
  await openFile(state.file, mine());
}

// One that fails keeps no other from being done.
const next = (work) => (line = line.catch(() => {}).then(work));

const mine = () => ({ tree: state.tree, path: state.path });

// Back to the text before the last operation, or forward again.
export function undo() {
  if (ofDraft()) inDraft("undo");
  else travel(state.past, state.future);
}

export function redo() {
  if (ofDraft()) inDraft("redo");
  else travel(state.future, state.past);
}

// The buttons follow the tree that is shown, not the draft, which is a step ahead until that is read again.
const inDraft = (way) =>
  next(async () => {
    behind = true;
    try {
      if (await make.step(way)) await reload();
    } finally {
      behind = false;
      buttons();
    }
  });

function travel(from, to) {
  next(() => {
    if (!from.length) return;
    to.push({ ...mine(), now: state.now });
    Object.assign(state, from.pop());
    draw();
  });
}

// Show all of it anew; the focus stays on the node where it was in the tree.
export function draw() {
  if (!tree()) state.tree = (state.now.trees.find(({ main }) => main) ?? state.now.trees[0])?.name;
  if (!node()) state.path = "root";
  drawTrees();
  rows.draw();
  form.draw();
  palette.trees();
  const general = state.now.marks.filter(({ path }) => path === null || path === "");
  box("general").replaceChildren(...general.map(form.markItem));
  buttons();
}

function buttons() {
  const known = make.draft.state;
  button("undo").disabled = ofDraft() ? !known?.undo : !state.past.length;
  button("redo").disabled = ofDraft() ? !known?.redo : !state.future.length;
}

const button = (act) => document.querySelector(`[data-draw="${act}"]`);

function drawTrees() {
  const known = state.now.trees.map(({ name, main }) => {
    const made = Object.assign(document.createElement("button"), { type: "button", className: "choice", textContent: main ? `★ ${name}` : name });
    made.dataset.drawTree = name;
    made.setAttribute("aria-pressed", name === state.tree);
    return made;
  });
  const held = document.activeElement?.dataset.drawTree;
  box("trees").replaceChildren(...known);
  if (held) known.find((each) => each.dataset.drawTree === held)?.focus();
}

export function choose(path, { focus = false } = {}) {
  state.path = path;
  rows.mark();
  form.draw();
  if (focus) rows.focus();
}
