// What the operators' verbs are for: the plant, a cell or a device; and which of them are offered for it.

import * as acts from "./acts.js";
import { onChange, value } from "./live.js";
import { all } from "./shell.js";

let scope = "";

export function start() {
  onChange(suggest);
  document.addEventListener("click", clicked);
  choose("");
}

const cellOf = (of) => all("[data-robots]").find((box) => box.dataset.robots === of || box.querySelector(`[data-scope="${CSS.escape(of)}"]`))?.dataset.robots ?? "";

export function choose(of) {
  const kinds = document.querySelector(`[data-scope="${CSS.escape(of)}"]`).dataset.kind.split(" ");
  scope = of;
  acts.setScope(of);
  const cell = cellOf(of);
  all("[data-scope]").forEach((each) => each.setAttribute("aria-pressed", each.dataset.scope === of || (each.dataset.kind.startsWith("cell") && each.dataset.scope === cell)));
  all("[data-robots]").forEach((box) => (box.hidden = box.dataset.robots !== cell));
  all("[data-advice]").forEach((line) => (line.hidden = line.dataset.advice !== cell));
  all(".verb").forEach((verb) => (verb.hidden = !verb.dataset.scopes.split(" ").some((each) => kinds.includes(each))));
  suggest();
}

function suggest() {
  const words = (value(`text/suggested.${scope || "plant"}`)?.[0] ?? "").split(" ");
  const refused = JSON.parse(value(`text/refused.${scope || "plant"}`)?.[0] || "{}");
  for (const verb of all(".verb")) {
    const why = refused[verb.dataset.verb];
    const says = verb.querySelector("[data-does]");
    verb.classList.toggle("suggested", words.includes(verb.dataset.verb));
    const act = verb.querySelector(".act");
    const held = why !== undefined && act === document.activeElement;
    act.disabled = why !== undefined;
    if (held) document.getElementById("menu").focus({ preventScroll: true }); // not at another verb, which Enter would do
    says.textContent = why ?? says.dataset.does;
  }
}

function clicked(event) {
  const of = event.target.closest("button")?.dataset.scope;
  if (of !== undefined) choose(of);
}
