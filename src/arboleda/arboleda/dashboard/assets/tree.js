// Draws a cell's tree once per task, then only changes the classes of its nodes.

import { onChange, split, value } from "./live.js";

const SVG = "http://www.w3.org/2000/svg";
const HEIGHT = 26;
const MARGIN = 32; // px below a tree
const PLANS = ["wide", "columns", "narrow"];
const SIGNS = {
  // status -> shape, 12 x 12 px around 0 0: it reads without its colour
  idle: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0",
  running: "M-4 -6L6 0L-4 6Z",
  success: "M-6 0L-2 5L6 -5",
  failure: "M-5 -5L5 5M5 -5L-5 5",
  halted: "M-4 -5V5M4 -5V5",
};
const COMPOSITES = ["selector", "sequence", "parallel"];
const drawn = new Map(); // cell -> {box, tree, svg, nodes, plan, zoom}
let chosen = null; // {cell, path}

export function start() {
  onChange((patch) => {
    for (const key of Object.keys(patch)) if (key.startsWith("tree/")) draw(split(key)[1]);
    for (const [key, now] of Object.entries(patch)) if (key.startsWith("node/")) show(split(key)[1], now);
    if (chosen && patch[`node/${chosen.cell}/${chosen.path}`]) describe();
  });
  document.addEventListener("click", clicked);
  document.addEventListener("keydown", pressed);
  new ResizeObserver(() => drawn.forEach((_, cell) => fit(cell))).observe(document.querySelector(".cells"));
}

export const refit = () => drawn.forEach((_, cell) => fit(cell));

function draw(cell) {
  const box = document.querySelector(`[data-tree="${CSS.escape(cell)}"]`);
  const tree = value(`tree/${cell}`);
  if (!box || !tree) return;
  box.parentElement.classList.toggle("is-empty", tree.nodes.length === 0);
  drawn.set(cell, { box, tree, nodes: new Map(), plan: null, zoom: drawn.get(cell)?.zoom ?? 1 });
  if (chosen?.cell === cell) close();
  fit(cell);
}

// From left to right where that fits at a readable size, else as outlines; a phone is scrolled. On a wall nobody
// scrolls: there the whole tree is in sight, as large as that allows.
function fit(cell) {
  const one = drawn.get(cell);
  if (one.tree.nodes.length === 0) return one.box.replaceChildren();
  if (one.box.clientWidth === 0) return;
  const unit = parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
  const wall = matchMedia("(min-width: 1800px)").matches && document.querySelector(".cells.few");
  const room = { w: one.box.clientWidth / unit, h: (innerHeight - top(one.box) - MARGIN) / unit };
  const [name, scale] = wall ? largest(one.tree, room) : readable(one.tree, room);
  if (one.plan !== name) lay(cell, one, name);
  one.svg.setAttribute("width", one.tree[name].w * scale * unit * one.zoom);
  one.svg.setAttribute("height", one.tree[name].h * scale * unit * one.zoom);
}

const top = (box) => box.getBoundingClientRect().top + scrollY;

function largest(tree, room) {
  const scales = PLANS.map((name) => [name, Math.min(1.5, room.w / tree[name].w, room.h / tree[name].h)]);
  const [name, scale] = scales.reduce((best, one) => (one[1] > best[1] ? one : best));
  return [name, Math.max(0.5, scale)];
}

function readable(tree, room) {
  const least = matchMedia("(max-width: 760px)").matches ? 1 : 0.85;
  const name = PLANS.find((name) => room.w / tree[name].w >= least) ?? PLANS.at(-1);
  const high = Math.max(0.9, room.h / tree[name].h);
  return [name, Math.max(least, Math.min(1.3, room.w / tree[name].w, high))];
}

function lay(cell, one, name) {
  const plan = one.tree[name];
  one.plan = name;
  one.svg = make("svg", { viewBox: `0 0 ${plan.w} ${plan.h}`, role: "group" });
  one.nodes = new Map();
  for (const node of one.tree.nodes) {
    const line = plan.lines[node.path] && make("path", { d: plan.lines[node.path], class: "line" });
    if (line) one.svg.append(line);
    one.nodes.set(node.path, { line });
  }
  for (const node of one.tree.nodes) one.svg.append(drawNode(cell, one, node, plan.at[node.path]));
  one.box.replaceChildren(one.svg);
  for (const node of one.tree.nodes) show(`${cell}/${node.path}`, value(`node/${cell}/${node.path}`));
}

function drawNode(cell, one, node, [x, y, w]) {
  const group = make("g", { transform: `translate(${x} ${y})`, role: "treeitem", tabindex: one.nodes.size && node.path !== "root" ? -1 : 0 });
  Object.assign(group.dataset, { cell, path: node.path, kind: node.kind });
  const round = COMPOSITES.includes(node.kind) ? HEIGHT / 2 : 5;
  const sign = make("path", { class: "sign", transform: `translate(15 ${HEIGHT / 2})` });
  const name = make("text", { x: 28, y: HEIGHT / 2 + 4.5 });
  name.textContent = node.label;
  group.append(make("rect", { width: w, height: HEIGHT, rx: round }), sign, name);
  Object.assign(one.nodes.get(node.path), { group, sign, name: node.name });
  return group;
}

function show(where, now) {
  const [cell, path] = split(where);
  const node = drawn.get(cell)?.nodes.get(path);
  if (!node?.group || !now) return;
  node.group.setAttribute("class", `node is-${now.state}${now.current ? " current" : ""}`);
  node.group.setAttribute("aria-label", `${node.name}: ${now.word}`);
  node.sign.setAttribute("d", SIGNS[now.state]);
  node.line?.setAttribute("class", `line is-${now.state}`);
  if (now.current) follow(cell, node.group);
}

// Keep the current leaf in sight where the tree is larger than its box.
function follow(cell, group) {
  const box = drawn.get(cell).box;
  if (box.scrollWidth <= box.clientWidth && box.scrollHeight <= box.clientHeight) return;
  if (box.matches(":hover, :focus-within")) return;
  const [at, view] = [group.getBoundingClientRect(), box.getBoundingClientRect()];
  box.scrollBy({ left: at.left - view.left - view.width / 3, top: at.top - view.top - view.height / 2 });
}

function clicked(event) {
  const node = event.target.closest?.("g.node");
  if (node) return choose(node);
  if (event.target.closest("#node-close")) return close();
  const zoom = event.target.closest("[data-zoom]");
  if (zoom) zoomBy(zoom.closest("article").dataset.cell, zoom.dataset.zoom);
}

function zoomBy(cell, how) {
  const one = drawn.get(cell);
  if (!one) return;
  one.zoom = how === "fit" ? 1 : Math.min(3, Math.max(0.4, one.zoom * (how === "larger" ? 1.25 : 0.8)));
  fit(cell);
}

function pressed(event) {
  if (event.key === "Escape") return close();
  const node = event.target.closest?.("g.node");
  if (!node) return;
  if (event.key === "Enter" || event.key === " ") return choose(node), event.preventDefault();
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[event.key];
  if (!step) return;
  event.preventDefault();
  const all = [...node.parentElement.querySelectorAll("g.node")];
  const next = all[all.indexOf(node) + step];
  if (!next) return;
  node.setAttribute("tabindex", -1);
  next.setAttribute("tabindex", 0);
  next.focus();
}

function choose(group) {
  chosen = { cell: group.dataset.cell, path: group.dataset.path };
  document.querySelectorAll("g.chosen").forEach((each) => each.classList.remove("chosen"));
  group.classList.add("chosen");
  describe();
}

function close() {
  chosen = null;
  document.getElementById("node").hidden = true;
  document.querySelectorAll("g.chosen").forEach((each) => each.classList.remove("chosen"));
}

function describe() {
  const fixed = value(`tree/${chosen.cell}`).nodes.find((node) => node.path === chosen.path);
  const now = value(`node/${chosen.cell}/${chosen.path}`);
  const { words } = window.arboledaPage;
  set("name", `${chosen.cell} · ${fixed.name}`);
  set("state", now.word).dataset.s = now.state;
  set("about", fixed.about);
  const since = now.since && words.since.replace("{time}", now.since);
  const left = now.left && words.left.replace("{time}", now.left);
  set("times", [since, left].filter(Boolean).join(" · "));
  set("feedback", now.feedback);
  set("failure", now.failure);
  const given = now.given.flatMap(([name, text]) => [element("dt", name), element("dd", text)]);
  document.getElementById("node-given").replaceChildren(...given);
  document.getElementById("node").hidden = false;
}

function set(name, text) {
  const found = document.getElementById(`node-${name}`);
  found.textContent = text;
  found.hidden = !text;
  return found;
}

function element(name, text) {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}

function make(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, one] of Object.entries(attributes)) made.setAttribute(key, one);
  return made;
}
