// The task form: cell, path and station write the task text, which may also be typed.

import { answer, send } from "./acts.js";
import * as place from "./place.js";

const words = window.arboledaPage.words;
const chosen = { cell: null, recipe: "storage", path: null, station: null, from: null };
const all = (selector, inside = document) => [...inside.querySelectorAll(selector)];
const maps = () => document.querySelector(`[data-maps="${CSS.escape(chosen.cell)}"]`);

export function start() {
  const form = document.getElementById("task-form");
  chosen.cell = form.querySelector('[data-choice="cell"]').dataset.value;
  form.addEventListener("click", clicked);
  form.addEventListener("submit", submitted);
  document.getElementById("task-send").addEventListener("click", submitted);
  show();
}

// Begin with this cell, unless somebody is writing a task already.
export function offer(cell) {
  if (!cell || document.getElementById("task-text").value) return;
  choose("cell", cell);
  show();
}

function clicked({ target }) {
  const button = target.closest("button");
  if (!button || button.id === "task-send") return;
  const { choice, value, path, station, node } = button.dataset;
  if (choice) choose(choice, value);
  if (path) chosen.path = path;
  if (station) chosen.station = station;
  if (node) walk(Number(node));
  show();
  write();
  if (choice === "cell") place.go({ cell: value });
}

function choose(what, value) {
  if (what === "cell" && value !== chosen.cell) Object.assign(chosen, { path: null, station: null, from: null });
  chosen[what] = value;
}

// A start, then an end: the path between them, the next one where there are several.
function walk(node) {
  const paths = all("[data-path]", maps()).map(({ dataset }) => ({ code: dataset.path, nodes: dataset.nodes.split("-").map(Number) }));
  const ends = paths.filter(({ nodes }) => nodes.at(-1) === node && (chosen.from === null || nodes[0] === chosen.from));
  if (ends.length && chosen.from !== null) {
    const after = ends.findIndex(({ code }) => code === chosen.path) + 1;
    chosen.path = ends[after % ends.length].code;
  } else if (paths.some(({ nodes }) => nodes[0] === node)) {
    Object.assign(chosen, { from: node, path: null });
  }
}

function show() {
  const storage = chosen.recipe === "storage";
  for (const button of all("[data-choice]")) press(button, chosen[button.dataset.choice] === button.dataset.value);
  for (const pair of all("[data-maps]")) pair.hidden = !storage || pair.dataset.maps !== chosen.cell;
  const way = nodesOf(chosen.path);
  if (way.length) chosen.from = way[0];
  for (const button of all("[data-path]", maps())) press(button, button.dataset.path === chosen.path);
  for (const button of all("[data-station]", maps())) press(button, button.dataset.station === chosen.station);
  for (const button of all("[data-node]", maps())) showNode(button, way);
  drawWay(way);
}

function nodesOf(code) {
  const found = code && maps().querySelector(`[data-path="${CSS.escape(code)}"]`);
  return found ? found.dataset.nodes.split("-").map(Number) : [];
}

function showNode(button, way) {
  const node = Number(button.dataset.node);
  button.classList.toggle("on-way", way.includes(node));
  press(button, way[0] === node || way.at(-1) === node || chosen.from === node);
}

function drawWay(way) {
  const box = maps().querySelector(".way");
  const columns = Number(maps().querySelector(".grid").dataset.columns);
  const rows = Math.ceil(all("[data-node]", maps()).length / columns);
  const points = way.map((node) => `${(node % columns) + 0.5},${Math.floor(node / columns) + 0.5}`).join(" ");
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", `0 0 ${columns} ${rows}`);
  const line = document.createElementNS("http://www.w3.org/2000/svg", "polyline");
  line.setAttribute("points", points);
  svg.append(line);
  box.replaceChildren(svg);
}

function press(button, on) {
  button.setAttribute("aria-pressed", on);
}

function write() {
  const words_ = chosen.recipe === "palletizing" ? [chosen.cell, "palletizing"] : [chosen.cell, chosen.path, chosen.station];
  document.getElementById("task-text").value = words_.filter((word) => word !== null).join(" ");
}

function submitted(event) {
  event.preventDefault();
  event.stopPropagation();
  const text = document.getElementById("task-text").value.trim();
  return text ? send("submit", text) : answer(words.empty_task, false);
}
