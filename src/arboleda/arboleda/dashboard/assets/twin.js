// The twin on the page: asks for frames while somebody looks, and has them drawn.

import { Plant } from "./twin_plant.js";
import { FlatView } from "./twin_flat.js";
import { PointsView } from "./twin_points.js";
import { SolidView } from "./twin_solid.js";

const ACK_EVERY = 5; // frames
const ASK_AGAIN_MS = 2000;
const words = () => window.arboledaPage.words;
let box, note, plant, view;
let near; // the cell that is looked at, null for the whole plant
let wanted = false;
let frames = 0;

window.arboledaTwin = {
  frame(number, patch) {
    if (!plant) return;
    plant.apply(patch);
    listRobots(patch); // the list takes of the room of the drawing
    view.resize?.();
    view.show();
    if (frames++ % ACK_EVERY === 0) tell("drawn", number);
  },
  // What is drawn solid, for whoever wants to compare it: robot -> link -> 16 numbers, row by row; and the middles of parts.
  links: () => plant?.links(),
  parts: () => plant?.middles(),
  solid: (robot) => plant.robots.get(robot).real.root.visible && plant.robots.get(robot).painted === "solid",
  drawn: () => Object.fromEntries(plant?.drawn ?? []),
  view: () => view?.name,
  visit(cell) {
    if (view && cell !== near) visit(cell);
  },
  // The plant from above in a box of another part of the page, with those of its targets as points that `of` is true of;
  // null where it has none.
  async points(box, { cell, of, ...choice }) {
    const [{ THREE }, scene] = await Promise.all([import("nicegui-scene"), fetchScene()]);
    const points = scene.targets.filter(of);
    if (!points.length) return null;
    const made = new Plant(THREE, scene);
    made.paint(color());
    if (plant) made.apply(Object.fromEntries(plant.drawn));
    const shown = new PointsView(THREE, box, made, { points, ...choice });
    shown.visit(cell);
    return shown;
  },
};

const tell = (...what) => window.emitEvent("arboleda-twin", ...what);

function look(seen) {
  if (seen === wanted) return;
  wanted = seen;
  if (!seen) tell("leave");
  else if (plant) ask();
  else open().catch((error) => say(error.message));
}

function ask() {
  frames = 0;
  tell("look");
  setTimeout(() => wanted && frames === 0 && ask(), ASK_AGAIN_MS);
}

let opening;

async function open() {
  opening ??= make();
  try {
    await opening;
  } catch (error) {
    opening = undefined; // the next look tries again
    wanted = false;
    throw error;
  }
  if (wanted) ask();
}

async function make() {
  const [{ THREE, OrbitControls }, scene] = await Promise.all([import("nicegui-scene"), fetchScene()]);
  const made = new Plant(THREE, scene);
  show(made, solid(THREE, OrbitControls, made) ?? flat(THREE, made));
  visit(document.querySelector("[data-choose][aria-pressed=true]")?.dataset.choose ?? null);
}

function visit(cell) {
  near = cell;
  view.visit(cell ?? undefined);
  document.getElementById("twin-title").textContent = cell ? words().twin_of.replace("{cell}", cell) : words().twin_plant;
}

async function fetchScene() {
  const answer = await fetch(document.querySelector("[data-scene]")?.dataset.scene ?? "/twin/scene.json");
  const said = await answer.json();
  if (!answer.ok) throw new Error(words().twin_failed.replace("{why}", said.sentence));
  return said;
}

function solid(THREE, OrbitControls, made) {
  if (!document.createElement("canvas").getContext("webgl2")) return null;
  try {
    return new SolidView(THREE, OrbitControls, box, made, () => show(made, flat(THREE, made)));
  } catch {
    return null; // there is WebGL, but none for us
  }
}

function flat(THREE, made) {
  say(note.dataset.flat);
  return new FlatView(THREE, box, made);
}

function show(made, how) {
  view?.close();
  [plant, view] = [made, how];
  how.seen?.then(() => (note.hidden = true));
  paint();
}

function say(sentence) {
  note.textContent = sentence;
  note.hidden = false;
}

function listRobots(patch) {
  const list = document.getElementById("twin-robots");
  for (const [key, drawn] of Object.entries(patch)) {
    if (!key.startsWith("robot/")) continue;
    const name = key.slice("robot/".length);
    const row = list.querySelector(`[data-robot="${CSS.escape(name)}"]`) ?? newRow(list, name);
    const text = `${name}: ${plant.wordOf(drawn)}`;
    if (row.textContent !== text) row.textContent = text;
    row.dataset.s = drawn.kind;
  }
}

function newRow(list, name) {
  const row = document.createElement("li");
  row.dataset.robot = name;
  list.append(row);
  return row;
}

function color() {
  const style = getComputedStyle(document.documentElement);
  return (name) => style.getPropertyValue(`--${name}`).trim();
}

function paint() {
  plant?.paint(color());
  view?.show();
}

function clicked(event) {
  const tool = event.target.closest?.("[data-twin]")?.dataset.twin;
  if (!tool || !view) return;
  if (tool === "reset") visit(null);
  else view.tool(tool);
}

function begin() {
  [box, note] = [document.getElementById("twin"), document.getElementById("twin-note")];
  let inSight = false;
  const seen = () => look(inSight && !document.hidden);
  new IntersectionObserver(([entry]) => ((inSight = entry.isIntersecting), seen())).observe(box);
  document.addEventListener("visibilitychange", seen);
  document.addEventListener("click", clicked);
  new MutationObserver(paint).observe(document.documentElement, { attributeFilter: ["data-look"] });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", paint);
}

(function wait() {
  if (document.getElementById("twin") && window.socket) begin();
  else setTimeout(wait, 20);
})();
