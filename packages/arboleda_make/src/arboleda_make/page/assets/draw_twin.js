// A target from the twin: the targets of a device as points of the plant, of which one becomes the value.

import { box, kindOf, node, say, state } from "./draw_state.js";
import { words } from "../shell.js";

const GOES = /^(.+)_(?:go|visit)$/;
let view = null;
let from = null; // the button that opened it

// Whether this value is a target of a device that may be in the twin.
export const isTarget = (port) => port.name === "target" && GOES.test(node()?.kind ?? "") && document.getElementById("twin") !== null;

export function button(port) {
  const made = Object.assign(document.createElement("button"), { type: "button", className: "act", textContent: words.draw_from_twin });
  made.dataset.fromTwin = port.name;
  return made;
}

export function start(choose) {
  box("twin").addEventListener("keydown", (event) => event.key === "Escape" && (event.stopPropagation(), close(true)));
  box("fields").addEventListener("click", ({ target }) => {
    const pressed = target.closest("[data-from-twin]");
    if (pressed) open(pressed.dataset.fromTwin, choose).catch((error) => say(error.message));
  });
  box("twin-close").addEventListener("click", () => close(true));
}

async function open(port, choose) {
  close();
  const { cell, tree, path } = state;
  const [{ kind, attributes }, role] = [node(), node().kind.match(GOES)[1]];
  const known = kindOf(kind)?.ports.find(({ name }) => name === port)?.words ?? [];
  box("twin").hidden = false;
  const here = () => state.tree === tree && state.path === path && !box("twin").hidden;
  const pick = (name) => (close(), choose(port, name));
  const made = await window.arboledaTwin.points(box("twin-view"), {
    cell,
    of: (each) => each.cell === cell && each.role === role && known.includes(each.name),
    chosen: attributes[port],
    choose: pick,
  });
  if (!made || !here()) return made?.close(), made ? undefined : (close(), say(words.draw_not_in_twin));
  view = made;
  from = port;
  (box("twin-view").querySelector("[aria-pressed=true]") ?? box("twin-view").querySelector("[data-point]")).focus();
}

// Take the points away; where the focus was in them it goes back to the value.
export function close(leads = false) {
  view?.close();
  view = null;
  box("twin").hidden = true;
  if (leads && from) box("fields").querySelector(`[data-from-twin="${CSS.escape(from)}"]`)?.focus();
}
