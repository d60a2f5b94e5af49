// The task form: cell, recipe and the recipe's values write the task text, which may also be typed.

import { send } from "./acts.js";
import { answer } from "./shell.js";
import * as place from "./place.js";

const words = window.arboledaPage.words;
const chosen = { cell: null, recipe: null, values: {}, from: null }; // values by parameter; from: where a path begins
const all = (selector, inside = form()) => [...inside.querySelectorAll(selector)];
const form = () => document.getElementById("task-form");
const text = () => document.getElementById("task-text");
const recipes = () => all('[data-choice="recipe"]').filter(({ dataset }) => dataset.cells.split(" ").includes(chosen.cell));
const fields = () => all("[data-fields]").find(({ dataset }) => dataset.fields === chosen.cell && dataset.recipe === chosen.recipe);

export function start() {
  chosen.cell = form().querySelector('[data-choice="cell"]')?.dataset.value ?? null;
  form().addEventListener("click", clicked);
  form().addEventListener("input", filled);
  form().addEventListener("submit", submitted);
  document.getElementById("task-send").addEventListener("click", submitted);
  begin();
}

function begin() {
  show();
  if (missing().length) (text().value = ""), ready();
  else write();
}

// Begin with this cell, unless somebody is writing a task already.
export function offer(cell) {
  const isBegun = text().value && (text().value !== written() || Object.values(chosen.values).some(Boolean));
  if (!cell || cell === chosen.cell || isBegun) return;
  choose("cell", cell);
  begin();
}

function clicked({ target }) {
  const button = target.closest("button");
  if (!button || button.id === "task-send") return;
  const { choice, value, set, path, station, node } = button.dataset;
  const name = button.closest("[data-parameter]")?.dataset.parameter;
  if (choice) choose(choice, value);
  if (name && (set ?? path ?? station)) chosen.values[name] = set ?? path ?? station;
  if (node) walk(name, Number(node));
  show();
  write();
  if (choice === "cell" && !value.includes(",")) place.go({ cell: value }); // several cells are no place
}

function filled({ target }) {
  const name = target.dataset.setFrom;
  if (!name) return ready();
  chosen.values[name] = target.value.trim() || undefined;
  write();
}

function choose(what, value) {
  if (value !== chosen[what]) Object.assign(chosen, { values: {}, from: null });
  chosen[what] = value;
}

// A start, then an end: the path between them, the next one where there are several.
function walk(name, node) {
  const paths = all("[data-path]", fields()).map(({ dataset }) => ({ code: dataset.path, nodes: nodes(dataset) }));
  const ends = paths.filter(({ nodes }) => nodes.at(-1) === node && (chosen.from === null || nodes[0] === chosen.from));
  if (ends.length && chosen.from !== null) {
    const after = ends.findIndex(({ code }) => code === chosen.values[name]) + 1;
    chosen.values[name] = ends[after % ends.length].code;
  } else if (paths.some(({ nodes }) => nodes[0] === node)) {
    Object.assign(chosen, { from: node });
    delete chosen.values[name];
  }
}

function show() {
  if (!recipes().some(({ dataset }) => dataset.value === chosen.recipe)) choose("recipe", recipes()[0]?.dataset.value ?? null);
  for (const button of all("[data-choice]")) press(button, chosen[button.dataset.choice] === button.dataset.value);
  for (const button of all('[data-choice="recipe"]')) button.hidden = !recipes().includes(button);
  for (const box of all("[data-fields]")) box.hidden = box !== fields();
  for (const box of all("[data-parameter]", fields() ?? form())) showValue(box, chosen.values[box.dataset.parameter]);
}

// What is chosen of one parameter, on whatever it is chosen with.
function showValue(box, value) {
  for (const button of all("[data-set], [data-path], [data-station]", box)) {
    const { set, path, station } = button.dataset;
    press(button, (set ?? path ?? station) === value);
  }
  for (const input of all("[data-set-from]", box)) if (input.value !== (value ?? "")) input.value = value ?? "";
  if (box.querySelector(".way")) showWay(box, value);
}

const nodes = (dataset) => dataset.nodes.split("-").map(Number);

function showWay(box, code) {
  const found = code && fields().querySelector(`[data-path="${CSS.escape(code)}"]`);
  const way = found ? nodes(found.dataset) : [];
  if (way.length) chosen.from = way[0];
  for (const button of all("[data-node]", box)) showNode(button, way);
  drawWay(box, way);
}

function showNode(button, way) {
  const node = Number(button.dataset.node);
  button.classList.toggle("on-way", way.includes(node));
  press(button, way[0] === node || way.at(-1) === node || chosen.from === node);
}

function drawWay(box, way) {
  const columns = Number(box.querySelector(".grid").dataset.columns);
  const rows = Math.ceil(all("[data-node]", box).length / columns);
  const points = way.map((node) => `${(node % columns) + 0.5},${Math.floor(node / columns) + 0.5}`).join(" ");
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", `0 0 ${columns} ${rows}`);
  const line = document.createElementNS("http://www.w3.org/2000/svg", "polyline");
  line.setAttribute("points", points);
  svg.append(line);
  box.querySelector(".way").replaceChildren(svg);
}

function press(button, on) {
  button.setAttribute("aria-pressed", on);
}

const parameters = () => JSON.parse(fields()?.dataset.parameters ?? "[]");
const missing = () => parameters().filter((name) => chosen.values[name] === undefined);

// The words of the task in their order; those that are still missing are left out.
function written() {
  const values = parameters().map((name) => chosen.values[name]);
  return [...JSON.parse(fields()?.dataset.head ?? "[]"), ...values].filter((word) => word !== undefined).join(" ");
}

function write() {
  text().value = written();
  ready();
}

// A task can be sent that somebody has typed, or of which all is chosen; else a line says what is not.
function ready() {
  const task = text().value.trim();
  const left = task && task !== written() ? [] : missing();
  const labels = left.map((name) => all(`[data-parameter="${CSS.escape(name)}"] > :is(legend, span)`, fields())[0].textContent);
  document.getElementById("task-send").disabled = !task || left.length > 0;
  document.getElementById("task-missing").textContent = labels.length ? words.still_to_choose.replace("{what}", labels.join(", ")) : "";
}

function submitted(event) {
  event.preventDefault();
  event.stopPropagation();
  if (document.getElementById("task-send").disabled) return answer(words.empty_task, false);
  return send("submit", text().value.trim());
}
