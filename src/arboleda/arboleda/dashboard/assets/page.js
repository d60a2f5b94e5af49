// The page's own behaviour: parts, cells, scopes, filters, language, look, and whether news still comes.

import * as acts from "./acts.js";
import * as form from "./form.js";
import * as history from "./history.js";
import { apply, drawList, onChange, setRowFilter, value } from "./live.js";
import * as oee from "./oee.js";
import * as place from "./place.js";
import * as question from "./question.js";
import * as sound from "./sound.js";
import * as task from "./task.js";
import * as tree from "./tree.js";

const SILENT_MS = 4000;
const ACK_EVERY = 5; // frames
const all = (selector) => [...document.querySelectorAll(selector)];
const filters = {};
let heardAt = 0;
let frames = 0;

window.arboleda = {
  live(number, patch) {
    begin();
    heardAt = Date.now();
    apply(patch);
    if (frames++ % ACK_EVERY === 0) window.emitEvent("arboleda", "seen", number);
    watch();
  },
  answer: acts.answer,
};

const words = window.arboledaPage.words;
const parts = () => all("[data-part]").map((part) => part.dataset.part);
const cells = () => all("[data-choose]").map((card) => card.dataset.choose);

function arrive({ tab, cell, task: named, lang }) {
  if (named && tab !== "tasks") return place.settle({ tab: "tasks" });
  if (!parts().includes(tab)) return place.settle({ tab: parts()[0] });
  if (cell && !cells().includes(cell)) return acts.answer(words.no_cell.replace("{cell}", cell), false), place.settle({ cell: null });
  if (lang !== window.arboledaPage.language) return place.settle({ lang: window.arboledaPage.language });
  question.dismiss(); // it was asked elsewhere
  showPart(tab);
  showCell(cell ?? cells()[0]);
  if (cellOf(scope.of) !== (cell ?? "")) chooseScope(cell ?? "");
  form.offer(cell);
  task.show(named);
  if (tab === "tasks") history.show(), oee.show();
  tree.close();
  tree.refit();
}

function showPart(chosen) {
  all("[data-part]").forEach((part) => (part.hidden = part.dataset.part !== chosen));
  all("[data-tab]").forEach((tab) => (tab.dataset.tab === chosen ? tab.setAttribute("aria-current", "page") : tab.removeAttribute("aria-current")));
}

function showCell(chosen) {
  all("article[data-cell]").forEach((cell) => cell.classList.toggle("chosen", cell.dataset.cell === chosen));
  all("[data-choose]").forEach((card) => card.setAttribute("aria-pressed", card.dataset.choose === chosen));
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

const ICONS = { trouble: "tree_trouble", waits: "tree_waits" };

// The tab of the browser, its icon and the header show trouble and who is waited for, also to whom another tab is open.
function alarm() {
  const [title, state] = value("text/title") ?? ["Arboleda", "well"];
  if (document.title !== title) document.title = title;
  if (document.documentElement.dataset.stands === state) return;
  document.documentElement.dataset.stands = state;
  const icon = document.querySelector("link[rel~=icon]");
  const home = document.querySelector("link[href$='/page.css']").href.replace("page.css", "");
  if (icon) icon.href = `${home}${ICONS[state] ?? "tree"}.svg`;
}

function filterBy(list, cell) {
  filters[list] = cell;
  all(`[data-filter="${list}"]`).forEach((each) => each.setAttribute("aria-pressed", each.dataset.value === cell));
  drawList(list);
}

function cookie(name, what) {
  document.cookie = `arboleda_${name}=${what}; path=/; max-age=31536000; SameSite=Strict`;
}

const LOOKS = ["auto", "light", "dark"];
const lookNow = () => document.cookie.match(/arboleda_look=(\w+)/)?.[1] ?? "auto";

function look(how) {
  document.documentElement.dataset.look = how;
  const button = document.querySelector(".look");
  button.dataset.look = how;
  button.title = `${words.look}: ${words[`look_${how}`]}`;
}

function nextLook() {
  const next = LOOKS[(LOOKS.indexOf(lookNow()) + 1) % LOOKS.length];
  cookie("look", next);
  look(next);
}

function clicked(event) {
  const button = event.target.closest("button");
  if (!button) return;
  const { choose, twinCell, scope: of, filter, value: cell, language } = button.dataset;
  if (choose ?? twinCell) place.go({ cell: choose ?? twinCell });
  if (of !== undefined) chooseScope(of), place.go({ cell: cellOf(of) || null });
  if (filter) filterBy(filter, cell);
  if (language) cookie("language", language), location.assign(place.address({ lang: language }));
  if (button.classList.contains("look")) nextLook();
}

// A page that hears nothing any more must not look as if all were well.
function watch() {
  const silent = Date.now() - heardAt > SILENT_MS;
  const line = document.getElementById("connection");
  document.documentElement.classList.toggle("silent", silent);
  line.hidden = heardAt > 0 && !silent;
  if (heardAt > 0 && silent) line.textContent = line.dataset.lost.replace("{time}", `${Math.round((Date.now() - heardAt) / 1000)} s`);
}

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  document.documentElement.lang = window.arboledaPage.language;
  look(lookNow());
  setRowFilter((list, row) => !filters[list] || row?.cell === filters[list]);
  acts.start();
  form.start();
  task.start();
  history.start();
  oee.start();
  tree.start();
  onChange(suggest);
  onChange(alarm);
  sound.start();
  onChange(sound.hear);
  document.addEventListener("click", clicked);
  chooseScope("");
  place.start(arrive);
  place.settle({});
  setInterval(watch, 1000);
}

const ready = () => document.querySelector(".app") && window.socket;
(function wait() {
  if (ready()) begin();
  else setTimeout(wait, 20);
})();
