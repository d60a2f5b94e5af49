// Faults by hand at virtual devices: which buttons are possible, and what they ask for.

import * as acts from "../acts.js";
import { onOpen } from "../menu.js";

const at = (id) => document.getElementById(id);

// `begin(kind, target, seconds)`: what a button does.
export function start(begin = (kind, robot, seconds) => acts.send("fault", robot, { kind, seconds })) {
  if (!at("fault-target")) return;
  at("fault-target").addEventListener("change", offer);
  document.addEventListener("click", ({ target }) => {
    const kind = target.closest("button")?.dataset.fault;
    if (kind) begin(kind, at("fault-target").value, Number(at("fault-seconds").value));
  });
  onOpen(ofCell);
  offer();
}

// Whom something can befall in the cell whose menu was opened.
function ofCell(cell) {
  const drawer = at("faults");
  if (!drawer) return; // they are for the whole plant here
  const targets = [...at("fault-target").options];
  for (const each of targets) each.hidden = each.disabled = !each.dataset.cells.split(" ").includes(cell);
  const first = targets.find((each) => !each.hidden);
  drawer.hidden = !first;
  if (!first) return;
  if (at("fault-target").selectedOptions[0]?.hidden ?? true) at("fault-target").value = first.value;
  offer();
}

// The buttons of what can befall the one that is chosen.
function offer() {
  const possible = at("fault-target").selectedOptions[0].dataset.kinds.split(" ");
  for (const button of document.querySelectorAll("[data-fault]")) button.hidden = !possible.includes(button.dataset.fault);
}
