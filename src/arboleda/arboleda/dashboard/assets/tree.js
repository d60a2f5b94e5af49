// Draws a cell's tree once per task, then only changes the classes of its nodes.

import { onChange, split, value } from "./live.js";

const SVG = "http://www.w3.org/2000/svg";
const HEIGHT = 26;
const MARGIN = 40; // px below a tree
const LEAST = { screen: 0.7, page: 0.85, phone: 1 }; // size at which a tree is read
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
const drawn = new Map(); // box -> {cell, tree, svg, nodes, plan, zoom}; a cell may be drawn in more than one box
const drawings = (cell) => [...drawn.values()].filter((one) => one.cell === cell);
let chosen = null; // {cell, path}

export function start() {
  onChange((patch) => {
    for (const key of Object.keys(patch)) if (key.startsWith("tree/")) draw(split(key)[1]);
    for (const [key, now] of Object.entries(patch)) if (key.startsWith("node/")) show(split(key)[1], now);
    if (chosen && patch[`node/${chosen.cell}/${chosen.path}`]) describe();
  });
  document.addEventListener("click", clicked);
  document.addEventListener("keydown", pressed);
  const resized = new ResizeObserver(refit);
  resized.observe(document.getElementById("parts"));
  resized.observe(document.getElementById("answer")); // an answer above a tree takes of its room
}

export const refit = () => drawn.forEach(fit);

function draw(cell) {
  const tree = value(`tree/${cell}`);
  if (chosen?.cell === cell) close();
  for (const box of document.querySelectorAll(`[data-tree="${CSS.escape(cell)}"]`)) {
    box.parentElement.classList.toggle("is-empty", tree.nodes.length === 0);
    drawn.set(box, { box, cell, tree, nodes: new Map(), plan: null, zoom: drawn.get(box)?.zoom ?? 1 });
    fit(drawn.get(box));
  }
}

// From left to right where that fits at a readable size, else as outlines; a phone is scrolled. On a wall nobody
// scrolls: there the whole tree is in sight, as large as that allows.
function fit(one) {
  if (one.tree.nodes.length === 0) return one.box.replaceChildren();
  if (one.box.clientWidth === 0) return;
  const unit = parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;
  const screen = getComputedStyle(one.box.parentElement).position === "absolute"; // the box is as high as the screen has room
  // A tree that begins low on the screen, or below it, gets half a screen: it has to be scrolled to anyway.
  const high = screen ? one.box.clientHeight : Math.max(innerHeight / 2, innerHeight - top(one.box) - MARGIN);
  const room = { w: one.box.clientWidth / unit, h: high / unit };
  const [name, scale] = screen ? largest(one.tree, room, LEAST.screen) : readable(one.tree, room);
  if (one.plan !== name) lay(one, name);
  one.svg.setAttribute("width", one.tree[name].w * scale * unit * one.zoom);
  one.svg.setAttribute("height", one.tree[name].h * scale * unit * one.zoom);
}

const top = (box) => box.getBoundingClientRect().top + scrollY;

// Which way it is drawn goes by the language that needs most room: it must not change with the language.
function largest(tree, room, least) {
  const scale = (name, width) => Math.min(1.5, room.w / width, room.h / tree[name].h);
  const name = PLANS.reduce((best, one) => (scale(one, tree.need[one]) > scale(best, tree.need[best]) ? one : best));
  return [name, Math.max(least, scale(name, tree[name].w))];
}

function readable(tree, room) {
  const least = matchMedia("(max-width: 760px)").matches ? LEAST.phone : LEAST.page;
  const name = PLANS.find((name) => room.w / tree.need[name] >= least) ?? PLANS.at(-1);
  const high = Math.max(0.9, room.h / tree[name].h);
  return [name, Math.max(least, Math.min(1.3, room.w / tree[name].w, high))];
}

function lay(one, name) {
  const plan = one.tree[name];
  one.plan = name;
  one.svg = make("svg", { viewBox: `0 0 ${plan.w} ${plan.h}`, role: "group" });
  one.nodes = new Map();
  for (const node of one.tree.nodes) {
    const line = plan.lines[node.path] && make("path", { d: plan.lines[node.path], class: "line" });
    if (line) one.svg.append(line);
    one.nodes.set(node.path, { line });
  }
  for (const node of one.tree.nodes) one.svg.append(drawNode(one, node, plan.at[node.path]));
  one.box.replaceChildren(one.svg);
  for (const node of one.tree.nodes) mark(one, node.path, value(`node/${one.cell}/${node.path}`));
}

function drawNode(one, node, [x, y, w]) {
  const group = make("g", { transform: `translate(${x} ${y})`, role: "treeitem", tabindex: one.nodes.size && node.path !== "root" ? -1 : 0 });
  Object.assign(group.dataset, { cell: one.cell, path: node.path, kind: node.kind });
  const round = COMPOSITES.includes(node.kind) ? HEIGHT / 2 : 5;
  const sign = make("path", { class: "sign", transform: `translate(15 ${HEIGHT / 2})` });
  const name = make("text", { x: 28, y: HEIGHT / 2 + 4.5 });
  name.textContent = node.label;
  const about = make("title", {});
  about.textContent = node.about;
  group.append(about, make("rect", { width: w, height: HEIGHT, rx: round }), sign, name);
  Object.assign(one.nodes.get(node.path), { group, sign, name: node.name });
  return group;
}

function show(where, now) {
  const [cell, path] = split(where);
  for (const one of drawings(cell)) mark(one, path, now);
}

function mark(one, path, now) {
  const node = one.nodes.get(path);
  if (!node?.group || !now) return;
  node.group.setAttribute("class", `node is-${now.state}${now.current ? " current" : ""}`);
  node.group.setAttribute("aria-label", `${node.name}: ${now.word}`);
  node.sign.setAttribute("d", SIGNS[now.state]);
  node.line?.setAttribute("class", `line is-${now.state}`);
  if (now.current) follow(one.box, node.group);
}

// Keep the current leaf in sight where the tree is larger than its box.
function follow(box, group) {
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
  if (zoom) zoomBy(drawn.get(zoom.closest(".tree-box").querySelector(".tree")), zoom.dataset.zoom);
}

function zoomBy(one, how) {
  if (!one) return;
  one.zoom = how === "fit" ? 1 : Math.min(3, Math.max(0.4, one.zoom * (how === "larger" ? 1.25 : 0.8)));
  fit(one);
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

export function close() {
  chosen = null;
  document.getElementById("node").hidden = true;
  document.querySelectorAll("g.chosen").forEach((each) => each.classList.remove("chosen"));
}

function describe() {
  const tree = value(`tree/${chosen.cell}`);
  const fixed = tree.nodes.find((node) => node.path === chosen.path);
  const now = value(`node/${chosen.cell}/${chosen.path}`);
  const { words } = window.arboledaPage;
  set("name", `${tree.title} · ${fixed.name}`);
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
