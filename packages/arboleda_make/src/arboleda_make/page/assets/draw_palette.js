// The palette: all kinds of nodes that the cell has, in groups; a press puts one in at the chosen node.

import { add } from "./draw_acts.js";
import { state } from "./draw_state.js";
import { words } from "../shell.js";

const box = () => document.getElementById("draw-kinds");
const search = () => document.getElementById("draw-search");

export function start() {
  box().addEventListener("click", ({ target }) => {
    const pressed = target.closest("[data-kind]");
    if (pressed) put(pressed);
  });
  search().addEventListener("input", find);
  search().addEventListener("keydown", (event) => {
    const first = [...box().querySelectorAll("[data-kind]")].find((each) => !each.hidden && !each.closest("details").hidden);
    if (event.key === "Enter" && first && search().value) put(first);
  });
}

const FIRST = ["device", "python", "usual"]; // the sorts of groups that stand before "More"
const put = ({ dataset: { kind, id } }) => add(kind, id ? { ID: id } : {});

export function fill(groups) {
  const made = groups.map(({ sort, name, kinds }, n) => group(name || words[`draw_${sort}`], kinds, n === 0 || sort === "usual"));
  const [first, others] = [true, false].map((is) => made.filter((_, n) => FIRST.includes(groups[n].sort) === is));
  const more = group(words.draw_more_kinds, [], false);
  more.append(...others);
  const own = group(words.draw_trees, [], true);
  own.id = "draw-own";
  box().replaceChildren(own, ...first, more);
}

function group(title, kinds, open) {
  const made = Object.assign(document.createElement("details"), { open });
  made.append(Object.assign(document.createElement("summary"), { textContent: title }), ...kinds.map((kind) => item(kind)));
  return made;
}

function item({ name, about, category }, id = "") {
  const made = Object.assign(document.createElement("button"), { type: "button", className: "draw-kind", title: about });
  Object.assign(made.dataset, { kind: name, category, ...(id && { id }) });
  const grip = Object.assign(document.createElement("span"), { className: "draw-grip", textContent: "⠿" });
  grip.setAttribute("aria-hidden", "true");
  const text = Object.assign(document.createElement("span"), { textContent: id || name });
  made.append(grip, text, Object.assign(document.createElement("small"), { textContent: about }));
  return made;
}

// The other trees of this file, of which a SubTree can be made.
export function trees() {
  const others = state.now.trees.filter(({ name }) => name !== state.tree);
  const own = document.getElementById("draw-own");
  const held = own.contains(document.activeElement) && document.activeElement.dataset.id;
  own.hidden = !others.length;
  own.replaceChildren(own.firstChild, ...others.map(({ name }) => item({ name: "SubTree", about: "", category: "SubTree" }, name)));
  if (held) own.querySelector(`[data-id="${CSS.escape(held)}"]`)?.focus();
}

function find() {
  const wanted = search().value.trim().toLowerCase();
  for (const details of box().querySelectorAll("details")) {
    const kinds = [...details.querySelectorAll("[data-kind]")];
    for (const each of kinds) each.hidden = Boolean(wanted) && !each.textContent.toLowerCase().includes(wanted);
    details.hidden = kinds.every((each) => each.hidden);
    if (wanted) details.open = true;
  }
}
