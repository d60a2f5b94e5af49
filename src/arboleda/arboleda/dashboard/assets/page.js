// The behaviour of a running plant's page: where one may be, scopes, and whether news still comes.

import * as acts from "./acts.js";
import * as demo from "./demo.js";
import * as draw from "./draw.js";
import * as faults from "./faults.js";
import * as form from "./form.js";
import * as history from "./history.js";
import * as frames from "./frames.js";
import { onChange } from "./live.js";
import * as make from "./make.js";
import * as oee from "./oee.js";
import * as place from "./place.js";
import * as question from "./question.js";
import * as scope from "./scope.js";
import * as shell from "./shell.js";
import * as sound from "./sound.js";
import * as task from "./task.js";
import * as teach from "./teach.js";
import * as tree from "./tree.js";
import * as versions from "./versions.js";

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
  scope.arrive(cell);
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

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  shell.start();
  acts.start();
  demo.start();
  faults.start();
  draw.start();
  make.start();
  form.start();
  task.start();
  teach.start();
  history.start();
  oee.start();
  tree.start();
  versions.start();
  scope.start();
  onChange(shell.alarm);
  sound.start();
  onChange(sound.hear);
  place.start(arrive);
  place.settle({});
  frames.start();
}

shell.whenReady(begin);
