// The behaviour of a running plant's page: where one may be, scopes, and whether news still comes.

import * as acts from "./acts.js";
import * as chart from "./chart.js";
import * as form from "./form.js";
import * as forms from "./forms.js";
import * as history from "./history.js";
import * as frames from "./frames.js";
import { onChange } from "./live.js";
import * as menu from "./menu.js";
import * as place from "./place.js";
import * as question from "./question.js";
import * as shell from "./shell.js";
import * as sound from "./sound.js";
import * as task from "./task.js";
import * as tree from "./tree.js";

window.arboleda = {
  live(number, patch) {
    begin();
    frames.hear(number, patch);
  },
  answer: acts.hear,
  over: acts.over,
};

function arrive(there) {
  if (!shell.settled(there)) return void (there.tab === "panel" && menu.open(place.here().cell ?? ""));
  const { tab, cell, task: named } = there;
  question.dismiss(); // it was asked elsewhere
  shell.showPart(tab);
  shell.showCell(cell);
  menu.arrive(there);
  form.offer(cell);
  task.show(named);
  if (tab === "tasks") history.show();
  for (const [each, name] of added) attempt(name, () => each.arrive?.(there));
  tree.close();
  tree.refit();
}

// Modules of packages, in the order of their names. They begin after the page itself: a stop does not wait for them.
// One that cannot be loaded is told of then, as there may be no page yet to tell it on.
const loading = window.arboledaPage.added.map(([address, name]) => [import(address), name]);
for (const [module] of loading) module.catch(() => {});
let added = [];

async function add() {
  const loaded = loading.map(async ([module, name]) => [await attempt(name, () => module), name]);
  added = (await Promise.all(loaded)).filter(([each]) => each);
  for (const [each, name] of added) attempt(name, () => each.start()), attempt(name, () => each.arrive?.(place.here()));
}

// A module that breaks keeps none of the others from going on; people are told which one it is.
async function attempt(name, act) {
  try {
    return await act();
  } catch (error) {
    console.error(error);
    const { script_broke } = window.arboledaPage.words;
    shell.answer(script_broke.replace("{package}", name).replace("{why}", error.message), false, true);
  }
}

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  shell.start();
  acts.start();
  form.start();
  forms.start();
  chart.start();
  task.start();
  history.start();
  tree.start();
  menu.start();
  onChange(shell.alarm);
  sound.start();
  onChange(sound.hear);
  place.start(arrive);
  place.settle({});
  frames.start();
}

shell.whenReady(() => (begin(), add()));
