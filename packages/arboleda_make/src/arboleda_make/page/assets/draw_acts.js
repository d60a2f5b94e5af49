// What can be done to the tree that is edited: each an operation on its text, by a button, a key or a drag.

import { copyRecipe, draw, edit, redo, undo } from "./draw.js";
import { box, childPath, childrenOf, indexOf, kindOf, node, parentOf, say, state } from "./draw_state.js";
import { words } from "../shell.js";

export function start(part) {
  part.addEventListener("click", clicked);
  part.addEventListener("keydown", pressed);
}

// Where a node put at the chosen one goes, or null, and why.
function room(path = state.path) {
  const there = node(path);
  if (!there) return { parent: "", index: 0 };
  if (!isFull(path)) return { parent: path, index: childrenOf(path).length };
  const parent = parentOf(path);
  if (parent !== null && !isFull(parent)) return { parent, index: indexOf(path) + 1 };
  return full(path);
}

const placed = ({ parent, index }) => (parent === "" ? "root" : childPath(parent, index));

const inTree = (more) => ({ tree: state.tree, ...more });

// A new node of this kind, as the palette says how.
export function add(kind, attributes = {}, place = null) {
  const made = { kind, attributes };
  const how = place ? "into" : state.how;
  let at = null;
  return edit(() => {
    const { path } = state;
    if (how === "around" && node()) return { do: "wrap", ...inTree({ path, node: made }) };
    if (how === "instead" && node()) return { do: "replace", ...inTree({ path, node: { kind, attributes: { ...kept(kind), ...attributes } } }) };
    at = place ?? (how === "before" && path !== "root" && node() ? { parent: parentOf(path), index: indexOf(path) } : room());
    return at && { do: "insert", ...inTree({ ...at, node: made }) };
  }, () => (say(words.draw_added.replace("{kind}", kind)), at && { path: placed(at) }));
}

// The values of the chosen node that another kind takes as well.
function kept(kind) {
  const ports = kindOf(kind)?.ports.map(({ name }) => name) ?? [];
  return Object.fromEntries(Object.entries(node().attributes).filter(([name]) => ports.includes(name)));
}

// `find` says which node goes where, [path, place], or null; it is asked once all before it is done.
export function move(find) {
  let to;
  const make = () => {
    const [path, place] = find() ?? [];
    if (!place) return null;
    to = after(path, place);
    return { do: "move", ...inTree({ path, to_tree: state.tree, ...place }) };
  };
  return edit(make, () => ({ path: to }));
}

// The path of a node that left `path` for a place.
function after(path, { parent, index }) {
  const [gone, to] = [steps(path), steps(childPath(parent, index))];
  const level = gone.length - 1;
  const beside = to.length > level && gone.slice(0, level).every((each, n) => to[n] === each);
  if (beside && to[level] > gone[level]) to[level] -= 1;
  return to.join(".");
}

const steps = (path) => (path === "root" ? [] : path.split(".").map(Number));

const ACTS = {
  undo,
  redo,
  download,
  copy_recipe: copyRecipe,
  up: () => step(-1),
  down: () => step(1),
  out: () => move(outwards),
  in: () => move(inwards),
  copy: () => {
    let to;
    edit(
      () => {
        const parent = parentOf(state.path);
        if (!node() || parent === null || isFull(parent)) return full(parent ?? "root");
        to = { parent, index: indexOf(state.path) + 1 };
        return { do: "move", ...inTree({ path: state.path, to_tree: state.tree, ...to, stays: true }) };
      },
      () => ({ path: placed(to) }),
    );
  },
  unwrap: () => edit(() => node() && { do: "unwrap", ...inTree({ path: state.path }) }),
  remove: () => {
    let next;
    edit(() => ((next = beside(state.path)), node() && { do: "remove", ...inTree({ path: state.path }) }), () => ({ path: next }));
  },
  add_tree: () => named((name) => edit(() => ({ do: "add_tree", name }), () => ({ tree: name, path: "root" }))),
  extract: () => named((name) => edit(() => ({ do: "extract", ...inTree({ path: state.path, name }) }))),
  rename_tree: () => named((name) => edit(() => ({ do: "rename_tree", ...inTree({ name }) }), () => ({ tree: name }))),
  remove_tree: () => edit(() => ({ do: "remove_tree", ...inTree({}) }), () => ({ tree: null })),
  add_parameter: () => named((name) => edit(() => ({ do: "set_parameter", ...inTree({ name }) }))),
};

const isFull = (path) => childrenOf(path).length >= node(path).most;
const full = (path) => (say(words.draw_full.replace("{kind}", node(path)?.kind ?? "")), null);

function step(by) {
  move(() => {
    const [{ path }, parent] = [state, parentOf(state.path)];
    if (parent === null) return null;
    const to = indexOf(path) + by;
    return to >= 0 && to < childrenOf(parent).length ? [path, { parent, index: by > 0 ? to + 1 : to }] : null;
  });
}

function outwards() {
  const parent = parentOf(state.path);
  if (parent === null || parent === "root") return null;
  return isFull(parentOf(parent)) ? full(parentOf(parent)) : [state.path, { parent: parentOf(parent), index: indexOf(parent) + 1 }];
}

function inwards() {
  const { path } = state;
  if (path === "root" || indexOf(path) === 0) return null;
  const before = childPath(parentOf(path), indexOf(path) - 1);
  return isFull(before) ? full(before) : [path, { parent: before, index: childrenOf(before).length }];
}

// The node that is chosen once this one has gone.
function beside(path) {
  const parent = parentOf(path);
  if (parent === null) return "root";
  if (indexOf(path) + 1 < childrenOf(parent).length) return path;
  return indexOf(path) ? childPath(parent, indexOf(path) - 1) : parent;
}

function named(go) {
  const name = box("name").value.trim();
  if (name) return (box("name").value = ""), go(name);
  say(words.draw_name_first);
  box("name").focus();
}

function download() {
  if (!state.now) return;
  const url = URL.createObjectURL(new Blob([state.now.text], { type: "application/xml" }));
  const name = state.files.find(({ recipe }) => recipe === state.file)?.file ?? "tree.xml";
  Object.assign(document.createElement("a"), { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
  state.saved = state.now.text;
}

function clicked({ target }) {
  const pressed = target.closest("button");
  if (!pressed) return;
  const { draw: act, drawTree, how, drawParameter } = pressed.dataset;
  if (act) ACTS[act]();
  if (drawTree) Object.assign(state, { tree: drawTree, path: "root" }), draw();
  if (drawParameter) edit(() => ({ do: "remove_parameter", ...inTree({ name: drawParameter }) }));
  if (how) {
    state.how = how;
    document.querySelectorAll("[data-how]").forEach((each) => each.setAttribute("aria-pressed", each.dataset.how === how));
  }
}

const KEYS = { ArrowUp: "up", ArrowDown: "down", ArrowLeft: "out", ArrowRight: "in" };

function pressed(event) {
  const typing = event.target.matches("input, select");
  if ((event.ctrlKey || event.metaKey) && !typing && ["z", "y"].includes(event.key.toLowerCase())) {
    event.preventDefault();
    return ACTS[event.key.toLowerCase() === "y" || event.shiftKey ? "redo" : "undo"]();
  }
  if (!event.target.closest(".draw-row")) return;
  const act = event.altKey ? KEYS[event.key] : event.key === "Delete" ? "remove" : (event.ctrlKey || event.metaKey) && event.key === "d" ? "copy" : null;
  if (!act) return;
  event.preventDefault();
  event.stopPropagation();
  ACTS[act]();
}
