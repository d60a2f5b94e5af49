// The behaviour of the page on many plants.

import * as acts from "../acts.js";
import * as frames from "../frames.js";
import { onChange, value } from "../live.js";
import * as place from "../place.js";
import * as shell from "../shell.js";

const at = (id) => document.getElementById(`site-${id}`);

window.arboleda = {
  live(number, patch) {
    begin();
    frames.hear(number, patch);
  },
  answer: shell.answer,
};

const stops = (of) => (of ? `plants/${encodeURIComponent(of)}` : "plants");

// The plants by name, whatever their order in the table; who has chosen one keeps it.
function offer(patch) {
  if (!patch["rows/plants"]) return;
  const names = [...value("rows/plants")].sort();
  const choice = at("plant");
  if ([...choice.options].map((each) => each.value).join() === names.join()) return;
  const chosen = choice.value;
  choice.replaceChildren(...names.map((name) => new Option(name, name, false, name === chosen)));
}

function submitted(event) {
  event.preventDefault();
  event.stopPropagation();
  const text = at("text").value.trim();
  return text ? acts.send("submit", at("plant").value, text) : shell.answer(shell.words.empty_task, false);
}

function arrive({ lang }) {
  if (lang !== window.arboledaPage.language) return place.settle({ lang: window.arboledaPage.language });
  shell.showPart("plants");
}

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  shell.start();
  acts.start(stops);
  onChange(offer);
  onChange(shell.alarm);
  at("form").addEventListener("submit", submitted);
  at("send").addEventListener("click", submitted);
  place.start(arrive);
  place.settle({});
  frames.start();
}

shell.whenReady(begin);
