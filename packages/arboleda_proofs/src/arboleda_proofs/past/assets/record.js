// The behaviour of a page on a record: which moment is shown, and the ways to other ones.

import { apply, onChange, value } from "../live.js";
import * as place from "../place.js";
import * as shell from "../shell.js";
import * as tree from "../tree.js";

const PLAY_MS = 100; // between two moments while it plays
const GROW_MS = 5000; // a record that is written on is longer by then
const NOTE_MS = 400; // browsers take a change of the address a few times a second
const WAYS = {
  failure_before: ["failure", -1],
  event_before: ["step", -1],
  event_after: ["step", 1],
  failure_after: ["failure", 1],
};
const KEYS = { ArrowLeft: "event_before", ArrowRight: "event_after", PageUp: "failure_before", PageDown: "failure_after" };
const at = (id) => document.getElementById(`record-${id}`);
const tell = (...what) => window.emitEvent("arboleda-past", ...what);

let began = 0;
let ended = 0;
let moment = null; // that is shown, ms of Unix time
let wanted = null; // that was asked for, until it is shown
let waiting = false; // for a frame
let task = place.here().task; // the one whose page is open
let playing = null;

window.arboleda = {
  live(_, patch) {
    begin();
    waiting = false;
    document.getElementById("connection").hidden = true;
    apply(patch);
    if (wanted !== null) ask();
  },
  answer(sentence, good) {
    waiting = false;
    shell.answer(sentence, good);
  },
};

// A slider that is dragged asks for the next moment once the one before is shown.
function go(to) {
  shell.answer("", true);
  wanted = Math.round(to);
  if (!waiting) ask();
}

function ask() {
  waiting = true;
  tell("go", wanted);
  wanted = null;
}

function step(way) {
  pause();
  shell.answer("", true);
  wanted = null;
  tell(...WAYS[way], at("cell").value);
}

let noting = null;

function shown(patch) {
  if (patch["past/span"]) span(patch["past/span"]);
  if (patch["past/starts"]) starts(patch["past/starts"]);
  if (patch["past/at"] === undefined) return;
  moment = patch["past/at"];
  const slider = at("slider");
  if (wanted === null && !dragged) slider.value = moment - began;
  slider.setAttribute("aria-valuetext", `${value("text/record.at")?.[0]} ${value("text/record.event")?.[0]}`);
  noting ??= setTimeout(() => ((noting = null), place.note({ at: address(moment) })), NOTE_MS);
}

const address = (ms) => (ms / 1000).toFixed(3);

// Sliders draw large numbers a little beside their place, so this one counts from the beginning of the record.
function span([first, last, marks]) {
  [began, ended] = [first, last];
  at("slider").max = ended - began;
  const share = (ms) => `${(100 * (ms - began)) / Math.max(1, ended - began)}%`;
  at("marks").replaceChildren(...marks.map((ms) => Object.assign(document.createElement("i"), { style: `left: ${share(ms)}` })));
}

// The records of the plant's starts; one of another plant file cannot be shown on this page.
function starts(rows) {
  const choice = at("start");
  choice.replaceChildren(...rows.map(([epoch, label, chosen, possible]) => Object.assign(new Option(label, epoch ?? "", chosen, chosen), { disabled: !possible })));
  choice.hidden = rows.length < 2;
}

function grow() {
  if (moment !== null && !waiting && !document.hidden) tell("grow");
}

let dragged = false;

function slides() {
  const slider = at("slider");
  slider.addEventListener("input", () => ((dragged = true), pause(), go(began + Number(slider.value))));
  slider.addEventListener("change", () => (dragged = false));
}

function play() {
  let last = performance.now();
  at("play").classList.add("playing");
  playing = setInterval(() => {
    if (waiting) return; // as fast as frames come
    const passed = performance.now() - last;
    last += passed;
    if (moment >= ended) return pause();
    go(Math.min(ended, moment + passed * Number(at("speed").value)));
  }, PLAY_MS);
  named("play", shell.words.record_pause);
}

function pause() {
  if (playing === null) return;
  clearInterval(playing);
  playing = null;
  at("play").classList.remove("playing");
  named("play", shell.words.record_play);
}

function named(id, name) {
  at(id).title = name;
  at(id).setAttribute("aria-label", name);
  at(id).textContent = playing === null ? "▶" : "❚❚";
}

function clicked(event) {
  const button = event.target.closest("button");
  if (button?.dataset.past) step(button.dataset.past);
  if (button === at("play")) playing === null ? play() : pause();
}

// Where keys mean something else they keep it: in a tree, a choice, a field.
function pressed(event) {
  if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
  const own = event.target.closest?.("g.node, select, #twin, input:not(#record-slider)");
  if (!own && KEYS[event.key]) return event.preventDefault(), step(KEYS[event.key]);
  if (event.key === " " && !event.target.closest?.("button, a, g.node, input, select")) event.preventDefault(), playing === null ? play() : pause();
}

function arrive(there) {
  if (!shell.settled(there)) return;
  const { tab, cell, task: named, at: asked } = there;
  shell.showPart(tab);
  shell.showCell(cell);
  open(named);
  if (moment !== null && Number(asked) && address(moment) !== asked) go(Number(asked) * 1000);
  tree.close();
  tree.refit();
}

function open(named) {
  document.getElementById("task").hidden = !named;
  if (named === task) return;
  task = named;
  tell("task", named);
}

function watch() {
  const lost = !(window.socket?.connected && window.did_handshake);
  const line = document.getElementById("connection");
  document.documentElement.classList.toggle("silent", lost);
  if (moment === null) return;
  line.hidden = !lost;
  if (lost) line.textContent = line.dataset.lost;
}

let begun = false;

function begin() {
  if (begun) return;
  begun = true;
  shell.start();
  tree.start();
  slides();
  onChange(shown);
  onChange(shell.alarm);
  document.addEventListener("click", clicked);
  document.addEventListener("keydown", pressed);
  if (place.here().cell) at("cell").value = place.here().cell;
  place.start(arrive);
  place.settle({});
  at("start").addEventListener("change", () => location.assign(place.address({ record: at("start").value || null, at: "failure", task: null })));
  setInterval(watch, 1000);
  setInterval(grow, GROW_MS);
}

shell.whenReady(begin);
