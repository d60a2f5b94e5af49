// The rows of the tree that is edited: an outline, with the keys of a tree, and what is dragged into it.

import { choose } from "./draw.js";
import { add, move } from "./draw_acts.js";
import { childrenOf, indexOf, node, parentOf, state, tree } from "./draw_state.js";

const SIGNS = { Sequence: "→", Fallback: "?", Parallel: "⇉" };
const OF_CATEGORY = { Control: "▤", Decorator: "◇", Condition: "≟", Action: "▪", SubTree: "⤷" };
const FAR = 6; // px that a pointer goes before it drags
const EDGE = 40; // px at which a dragged node scrolls
const folded = new Set(); // "tree path"
const box = () => document.getElementById("draw-rows");
const all = () => [...box().querySelectorAll(".draw-row:not([hidden])")];
const rowOf = (path) => box().querySelector(`[data-path="${CSS.escape(path)}"]`);

export function start() {
  box().addEventListener("click", clicked);
  box().addEventListener("keydown", pressed);
  document.getElementById("draw").addEventListener("pointerdown", taken);
}

export function draw() {
  const held = box().contains(document.activeElement);
  const counts = new Map();
  for (const { path } of tree()?.nodes ?? []) counts.set(parentOf(path), (counts.get(parentOf(path)) ?? 0) + 1);
  const marks = grouped(here());
  box().replaceChildren(...(tree()?.nodes ?? []).map((each) => row(each, counts, marks.get(each.path) ?? [])));
  fold();
  mark();
  if (held) focus();
}

const here = () => state.now.marks.filter((each) => each.tree === state.tree && each.path);

function grouped(marks) {
  const found = new Map(marks.map(({ path }) => [path, []]));
  for (const each of marks) found.get(each.path).push(each);
  return found;
}

export function titleOf({ kind, attributes }) {
  const { name, ID, ...rest } = attributes;
  const own = name || (kind === "SubTree" ? ID : kind);
  const values = Object.entries(rest).filter(([key]) => !key.startsWith("_")).map(([key, value]) => `${key}=${value}`);
  return [own ?? kind, [name ? (kind === "SubTree" ? ID : kind) : "", ...values].filter(Boolean).join(" ")];
}

function row(each, counts, marks) {
  const made = Object.assign(document.createElement("div"), { className: "draw-row", tabIndex: -1 });
  const { path } = each;
  const steps = path === "root" ? 0 : path.split(".").length;
  Object.assign(made.dataset, { path, category: each.category });
  const [title, more] = titleOf(each);
  const many = counts.get(path) ?? 0;
  made.style.setProperty("--level", steps);
  const found = { role: "treeitem", "aria-level": steps + 1, "aria-posinset": path === "root" ? 1 : indexOf(path) + 1, "aria-setsize": counts.get(parentOf(path)) };
  if (many) found["aria-expanded"] = true;
  const sentences = marks.map(({ sentence }) => sentence);
  found["aria-label"] = [title, more, ...sentences].filter(Boolean).join(", ");
  for (const [key, value] of Object.entries(found)) made.setAttribute(key, value);
  if (marks.length) made.dataset.mark = marks.some(({ mistake }) => mistake) ? "mistake" : "warning";
  made.append(part("draw-grip", "⠿"), part("draw-fold", many ? "▾" : ""), part("draw-sign", sign(each)), part("draw-label", title), part("draw-more", more));
  if (marks.length) made.append(part("draw-flag", `▲ ${marks.length}`)), (made.title = sentences.join("\n"));
  return made;
}

const sign = ({ kind, category }) => Object.entries(SIGNS).find(([word]) => kind.includes(word))?.[1] ?? OF_CATEGORY[category] ?? "▪";

function part(name, text) {
  const made = Object.assign(document.createElement("span"), { className: name, textContent: text });
  made.setAttribute("aria-hidden", "true");
  return made;
}

const key = (path) => `${state.tree} ${path}`;

function fold() {
  const hidden = new Set();
  for (const each of box().children) {
    const { path } = each.dataset;
    const above = parentOf(path);
    each.hidden = above !== null && (hidden.has(above) || folded.has(key(above)));
    if (each.hidden) hidden.add(path);
    if (each.hasAttribute("aria-expanded")) {
      each.setAttribute("aria-expanded", !folded.has(key(path)));
      each.querySelector(".draw-fold").textContent = folded.has(key(path)) ? "▸" : "▾";
    }
  }
}

export function mark() {
  for (let path = parentOf(state.path); path !== null; path = parentOf(path)) if (folded.delete(key(path))) fold();
  for (const each of box().querySelectorAll('[aria-selected="true"]')) each.setAttribute("aria-selected", "false"), (each.tabIndex = -1);
  const found = rowOf(state.path);
  if (!found) return;
  found.setAttribute("aria-selected", "true");
  found.tabIndex = 0;
}

export const focus = () => rowOf(state.path)?.focus();

function clicked({ target }) {
  const found = target.closest(".draw-row");
  if (!found) return;
  if (target.closest(".draw-fold")) toggle(found.dataset.path);
  choose(found.dataset.path, { focus: true });
}

function toggle(path) {
  if (!folded.delete(key(path))) folded.add(key(path));
  fold();
}

function pressed(event) {
  const found = event.target.closest(".draw-row");
  if (!found || event.altKey || event.ctrlKey || event.metaKey) return;
  const { path } = found.dataset;
  const rows = all();
  const at = rows.indexOf(found);
  const isOpen = found.getAttribute("aria-expanded");
  const go = {
    ArrowDown: () => rows[at + 1],
    ArrowUp: () => rows[at - 1],
    Home: () => rows[0],
    End: () => rows.at(-1),
    ArrowRight: () => (isOpen === "false" ? toggle(path) : isOpen ? rows[at + 1] : null),
    ArrowLeft: () => (isOpen === "true" ? toggle(path) : rowOf(parentOf(path) ?? "")),
    Enter: () => document.querySelector("#draw-fields input, #draw-fields select")?.focus(),
    Insert: () => document.getElementById("draw-search").focus(),
    "+": () => document.getElementById("draw-search").focus(),
  }[event.key];
  if (!go) return;
  event.preventDefault();
  const next = go();
  if (next) choose(next.dataset.path, { focus: true });
}

// --- dragging: of a row, or of a kind of the palette; by touch only at the grip, as a finger scrolls elsewhere

let drag = null; // {x, y, path or kind and id, ghost, place, row}

function taken(event) {
  const from = event.target.closest(".draw-row, [data-kind]");
  if (!from || event.button || (event.pointerType !== "mouse" && !event.target.closest(".draw-grip"))) return;
  const { path, kind, id } = from.dataset;
  if (path === "root") return;
  drag = { x: event.clientX, y: event.clientY, path, kind, id };
  for (const [name, hears] of Object.entries(HEARS)) window.addEventListener(name, hears, { passive: false });
}

const HEARS = { pointermove: dragged, pointerup: dropped, pointercancel: forget, keydown: escaped };

function dragged(event) {
  if (!drag.ghost && Math.hypot(event.clientX - drag.x, event.clientY - drag.y) < FAR) return;
  event.preventDefault();
  drag.ghost ??= lift();
  drag.ghost.style.transform = `translate(${event.clientX + 12}px, ${event.clientY + 12}px)`;
  if (event.clientY < EDGE) scrollBy(0, -EDGE / 2);
  if (event.clientY > innerHeight - EDGE) scrollBy(0, EDGE / 2);
  aim(event);
}

function lift() {
  const text = drag.path ? titleOf(node(drag.path))[0] : drag.kind === "SubTree" ? drag.id : drag.kind;
  const ghost = Object.assign(document.createElement("div"), { className: "draw-ghost", textContent: text });
  document.getElementById("draw").append(ghost);
  getSelection().removeAllRanges();
  document.documentElement.classList.add("drawing");
  return ghost;
}

function aim({ clientX, clientY }) {
  const row = document.elementFromPoint(clientX, clientY)?.closest("#draw-rows .draw-row");
  drag.row?.removeAttribute("data-drop");
  Object.assign(drag, { row: null, place: null });
  if (!row) return;
  const { top, height } = row.getBoundingClientRect();
  const where = placeAt(row.dataset.path, (clientY - top) / height);
  if (!where) return;
  row.dataset.drop = where.how;
  Object.assign(drag, { row, place: where.place });
}

// Before, after or into a node, by where on its row the pointer is, and where there is room.
function placeAt(path, share) {
  if (drag.path && (path === drag.path || path.startsWith(`${drag.path}.`))) return null;
  const isHere = (parent) => drag.path !== undefined && parentOf(drag.path) === parent;
  const hasRoom = (parent) => parent !== null && (isHere(parent) || childrenOf(parent).length < node(parent).most);
  const parent = parentOf(path);
  const into = hasRoom(path) && node(path).most > 0 && { how: "into", place: { parent: path, index: childrenOf(path).length } };
  if (into && (parent === null || (share > 0.3 && share < 0.7))) return into;
  if (!hasRoom(parent)) return into || null;
  const how = share < 0.5 ? "before" : "after";
  return { how, place: { parent, index: indexOf(path) + (how === "after") } };
}

function dropped() {
  const { path, kind, id, place, ghost } = drag;
  forget();
  if (!ghost) return;
  window.addEventListener("click", swallow, { capture: true, once: true });
  setTimeout(() => window.removeEventListener("click", swallow, { capture: true }));
  if (place && path) move(() => [path, place]);
  else if (place) add(kind, id ? { ID: id } : {}, place);
}

function swallow(event) {
  event.stopPropagation();
  event.preventDefault();
}

function escaped(event) {
  if (event.key === "Escape") forget();
}

function forget() {
  for (const [name, hears] of Object.entries(HEARS)) window.removeEventListener(name, hears);
  drag.ghost?.remove();
  drag.row?.removeAttribute("data-drop");
  document.documentElement.classList.remove("drawing");
  drag = null;
}

