// The behaviour of a running plant's page: where one may be, scopes, and whether news still comes.

import * as acts from "./acts.js";
import * as demo from "./demo.js";
import * as draw from "./draw.js";
import * as form from "./form.js";
import * as history from "./history.js";
import * as frames from "./frames.js";
import { onChange, value } from "./live.js";
import * as make from "./make.js";
import * as oee from "./oee.js";
import * as place from "./place.js";
import * as question from "./question.js";
import * as shell from "./shell.js";
import * as sound from "./sound.js";
import * as task from "./task.js";
import * as teach from "./teach.js";
import * as tree from "./tree.js";
import * as versions from "./versions.js";

const { all } = shell;

window.arboleda = {
  live(number, patch) {
    begin();
    frames.hear(number, patch);
  },
  answer: shell.answer,
};

function arrive(there) {
  if (!shell.settled(there)) return;
  const { tab, cell, task: named } = there;
  question.dismiss(); // it was asked elsewhere
  shell.showPart(tab);
  shell.showCell(cell);
  if (cellOf(scope.of) !== (cell ?? "")) chooseScope(cell ?? "");
  form.offer(cell);
  task.show(named);
  if (tab === "tasks") versions.openAnew(), history.show(), oee.show();
  if (tab === "draw") draw.show(cell);
  if (tab === "teach") teach.show(cell);
  else teach.leave();
  make.show(tab === "make");
  if (tab === "links") versions.show();
  tree.close();
  tree.refit();
}

let scope = { of: "" };

const cellOf = (of) => all("[data-robots]").find((box) => box.dataset.robots === of || box.querySelector(`[data-scope="${CSS.escape(of)}"]`))?.dataset.robots ?? "";

function chooseScope(of) {
  const kinds = document.querySelector(`[data-scope="${CSS.escape(of)}"]`).dataset.kind.split(" ");
  scope = { of };
  acts.setScope(of);
  const cell = cellOf(of);
  all("[data-scope]").forEach((each) => each.setAttribute("aria-pressed", each.dataset.scope === of || (each.dataset.kind.startsWith("cell") && each.dataset.scope === cell)));
  all("[data-robots]").forEach((box) => (box.hidden = box.dataset.robots !== cell));
  all("[data-advice]").forEach((line) => (line.hidden = line.dataset.advice !== cell));
  all(".verb").forEach((verb) => (verb.hidden = !verb.dataset.scopes.split(" ").some((each) => kinds.includes(each))));
  suggest();
}

function suggest() {
  const words = (value(`text/suggested.${scope.of || "plant"}`)?.[0] ?? "").split(" ");
  const refused = JSON.parse(value(`text/refused.${scope.of || "plant"}`)?.[0] || "{}");
  for (const verb of all(".verb")) {
    const why = refused[verb.dataset.verb];
    const says = verb.querySelector("[data-does]");
    verb.classList.toggle("suggested", words.includes(verb.dataset.verb));
    verb.querySelector(".act").disabled = why !== undefined;
    says.textContent = why ?? says.dataset.does;
  }
}

function clicked(event) {
  const of = event.target.closest("button")?.dataset.scope;
  if (of !== undefined) chooseScope(of), place.go({ cell: cellOf(of) || null });
}

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  shell.start();
  acts.start();
  demo.start();
  draw.start();
  make.start();
  form.start();
  task.start();
  teach.start();
  history.start();
  oee.start();
  tree.start();
  versions.start();
  onChange(suggest);
  onChange(shell.alarm);
  sound.start();
  onChange(sound.hear);
  document.addEventListener("click", clicked);
  chooseScope("");
  place.start(arrive);
  place.settle({});
  frames.start();
}

shell.whenReady(begin);
