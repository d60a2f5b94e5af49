// The menu of a cell or of the whole plant: opened by a button of it, closed by that, by Escape, and by going elsewhere.

import * as place from "./place.js";
import * as scope from "./scope.js";
import { all } from "./shell.js";

const box = () => document.getElementById("menu");
const listeners = [];
let of = null; // the cell, "" for the plant; null while it is closed
let tab = null; // where it was opened

export function onOpen(listener) {
  listeners.push(listener);
  if (of !== null) listener(of); // the script of a package may come after the menu was opened
}

export function start() {
  scope.start();
  document.addEventListener("click", clicked);
  document.addEventListener("keydown", pressed, true); // before an open question goes, which is closed alone
}

export function open(whose) {
  if (whose) place.go({ cell: whose });
  [of, tab] = [whose, place.here().tab];
  scope.choose(whose);
  for (const each of all("[data-menu-of]")) each.hidden = (each.dataset.menuOf === "cell") !== (whose !== "");
  for (const listener of listeners) listener(whose);
  show();
  box().focus();
}

// Somebody has gone to another part of the page, or to another cell.
export function arrive(there) {
  if (of !== null && (there.tab !== tab || (of && there.cell !== of))) close();
}

function close() {
  const opener = all(`[data-menu="${CSS.escape(of)}"]`)[0];
  const within = box().contains(document.activeElement);
  of = null;
  show();
  if (within) opener?.focus();
}

function show() {
  box().hidden = of === null;
  for (const each of all("[data-menu]")) each.setAttribute("aria-expanded", each.dataset.menu === of);
}

function clicked({ target }) {
  const button = target.closest("button");
  if (button?.id === "menu-close") return close();
  const whose = button?.dataset.menu;
  if (whose === undefined) return;
  if (whose === of) close();
  else open(whose);
}

function pressed({ key }) {
  if (key === "Escape" && of !== null && !document.querySelector("dialog")) close();
}
