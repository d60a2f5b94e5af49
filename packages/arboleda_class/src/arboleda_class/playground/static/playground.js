// A plant in this tab: the page's own scripts, with the time of the plant and what goes wrong in a person's hand.

import { ask, onStep, serve } from "./plant.js";

const TURN_MS = 60;
const MOST_TICKS = 160; // in one turn, so that a button is answered soon
const LOADING = {
  en: { python: "Python is loading ...", arboleda: "The plant is being built ...", open: "The plant is being built ..." },
  es: { python: "Se carga Python ...", arboleda: "Se monta la planta ...", open: "Se monta la planta ..." },
};
const PROGRESS = { python: 20, arboleda: 60, open: 85 };
const at = (id) => document.getElementById(id);
const asked = new URLSearchParams(location.search);
const cookie = document.cookie.match(/arboleda_language=(\w+)/)?.[1];
const languages = [asked.get("lang"), cookie, ...navigator.languages].filter(Boolean);
const spoken = languages.map((each) => each.slice(0, 2)).find((each) => LOADING[each]) ?? "en";
const RUN = "arboleda/run"; // of the browser's tab: what goes on in another language
let live, shell, tree; // the page's modules, which want its words when they are loaded
let clock = { tick: 0, latest: 0, tick_s: 1, marks: [] };
let playing = false;
let owed = 0; // ticks that have not passed yet
let turn = null; // the last request that moves time
let broke = null; // why nothing goes on

onStep(loading);
document.documentElement.lang = spoken;
start().catch(broken);

function loading(step) {
  if (!at("play-loading")) return;
  at("play-loading").textContent = LOADING[spoken][step];
  at("play-progress").style.width = `${PROGRESS[step]}%`;
}

async function start() {
  const left = leftOver();
  loading("python");
  const opened = await ask("open", { plant: asked.get("plant"), languages, seed: Number(asked.get("seed")) || 0, level: asked.get("faults") ?? "none", past: left?.past });
  if (opened.sentence) return (at("play-loading").textContent = opened.sentence);
  window.arboledaPage = opened.page;
  window.arboleda = { live: (_, patch) => live.apply(patch), answer: (...said) => shell.answer(...said) };
  serve(tell);
  document.querySelector(".app").innerHTML = opened.html; // made of the plant's file by the page's own Python, which escapes
  await page();
  show(opened.frame);
  at("connection").hidden = true;
  setInterval(pass, TURN_MS);
  play(left?.playing ?? true);
}

// The run that was left to be seen in another language, once.
function leftOver() {
  const left = JSON.parse(sessionStorage.getItem(RUN) ?? "null");
  sessionStorage.removeItem(RUN);
  return left?.of === whose() ? left : null;
}

// The plant of a workbook is that of the lesson or exercise whose page is around this one.
function whose() {
  return ["plant", "seed", "faults"].map((each) => asked.get(each)).join() + (asked.has("within") ? window.parent.location.search.replace(/&?lang=\w+/, "") : "");
}

async function leave() {
  const { past } = await ask("past");
  sessionStorage.setItem(RUN, JSON.stringify({ of: whose(), playing, past }));
}

// In another language the same plant goes on, at the same part of the page.
async function speak(language) {
  document.cookie = `arboleda_language=${language}; path=/; max-age=31536000; SameSite=Strict`;
  await leave();
  const now = new URLSearchParams(location.search);
  for (const each of ["tab", "cell", "task"]) now.has(each) ? asked.set(each, now.get(each)) : asked.delete(each);
  asked.set("lang", language);
  location.assign(`${location.pathname}?${asked}`);
}

// The parts of a plant's page that the playground has, in the order in which the page itself begins them.
async function page() {
  const module = (name) => import(`./assets/${name}.js`);
  const [acts, faults, form, menu, question, place, sound, task] = await Promise.all(["acts", "proofs/faults", "form", "menu", "question", "place", "sound", "task"].map(module));
  [live, shell, tree] = await Promise.all(["live", "shell", "tree"].map(module));
  if (at("twin")) await module("twin");
  shell.start();
  acts.start();
  form.start();
  task.start();
  tree.start();
  menu.start();
  live.onChange(shell.alarm);
  sound.start();
  live.onChange(sound.hear);
  faults.start((name, target, seconds) => move("befall", { name, target, seconds }).then(moment));
  wire();
  place.start((there) => {
    if (!shell.settled(there)) return void (there.tab === "panel" && menu.open(place.here().cell ?? ""));
    question.dismiss(); // it was asked elsewhere
    shell.showPart(there.tab);
    shell.showCell(there.cell);
    menu.arrive(there);
    form.offer(there.cell);
    task.show(there.task);
    tree.close();
    tree.refit();
  });
  place.settle({});
}

// What buttons of the page ask for. Where time stands still it passes for a moment, so that something happens.
function tell(event, act, of, more) {
  if (event === "arboleda-twin") return act === "look" || act === "leave" ? move("look", { on: act === "look" }) : null;
  if (act === "seen") return null;
  shell.answer("", true);
  return move("act", { act, of, more: more ?? null }).then(moment);
}

const moment = () => (playing ? null : move("advance", { ticks: 4 }));

async function move(what, request) {
  const mine = (turn = ask(what, request));
  try {
    const { frame, sentence } = await mine;
    if (sentence) shell.answer(sentence, false);
    if (frame) show(frame);
  } catch (error) {
    broken(error);
  } finally {
    if (turn === mine) turn = null;
  }
}

function show({ face, twin, said, clock: now }) {
  clock = now;
  live.apply(face);
  if (Object.keys(twin).length) window.arboledaTwin?.frame(0, twin);
  for (const [sentence, good] of said) shell.answer(sentence, good);
  const slider = at("play-slider");
  slider.max = clock.latest;
  if (!dragged) slider.value = clock.tick;
  const [, last] = clock.marks.findLast(([tick]) => tick <= clock.tick) ?? [];
  slider.setAttribute("aria-valuetext", [seconds(clock.tick), last].filter(Boolean).join(", "));
  at("play-clock").textContent = seconds(clock.tick);
  marks();
}

function seconds(ticks) {
  const whole = Math.floor(ticks * clock.tick_s);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
}

let marked = "";

function marks() {
  const shares = clock.marks.map(([tick, title]) => ({ tick, title, left: `${(100 * tick) / Math.max(1, clock.latest)}%` }));
  if (marked === (marked = JSON.stringify(shares))) return;
  at("play-marks").replaceChildren(
    ...shares.map(({ tick, title, left }) => Object.assign(document.createElement("i"), { title, style: `left: ${left}`, onclick: () => go("go", { tick }) })),
  );
}

let passed = performance.now();

// Time passes as fast as the plant can be worked out, and no faster than was chosen.
function pass() {
  const now = performance.now();
  if (playing) owed += ((now - passed) / 1000) * (Number(at("play-speed").value) / clock.tick_s);
  passed = now;
  if (playing && clock.ends) play(false);
  if (turn || !playing || owed < 1) return void (owed = Math.min(owed, MOST_TICKS));
  const ticks = Math.min(MOST_TICKS, Math.floor(owed));
  owed -= ticks;
  move("advance", { ticks });
}

function play(on) {
  playing = on;
  owed = 0;
  passed = performance.now();
  const button = document.querySelector("[data-play=play]");
  button.textContent = on ? "❚❚" : "▶";
  button.title = shell.words[on ? "js_pause" : "js_play"];
  button.setAttribute("aria-label", button.title);
}

async function go(what, request = {}) {
  play(false);
  if (what !== "step") shell.answer(shell.words.js_again, null);
  await move(what, request);
  if (what !== "step") shell.answer("", true);
}

const DOES = { begin: () => go("go", { tick: 0 }), back: () => go("back"), play: () => play(!playing), step: () => go("step") };
let dragged = false;

function wire() {
  document.addEventListener(
    "click",
    (event) => {
      const { language } = event.target.closest("button")?.dataset ?? {};
      if (!language) return;
      event.stopPropagation(); // on a plant's page a language loads it again, and its run is elsewhere
      speak(language);
    },
    true,
  );
  document.addEventListener("click", ({ target }) => {
    const { play: does } = target.closest("button")?.dataset ?? {};
    if (does) DOES[does]();
  });
  at("play-slider").addEventListener("input", () => ((dragged = true), (at("play-clock").textContent = seconds(at("play-slider").value))));
  at("play-slider").addEventListener("change", () => ((dragged = false), go("go", { tick: Number(at("play-slider").value) })));
  at("play-plant")?.addEventListener("change", () => location.assign(`${location.pathname}?${new URLSearchParams({ plant: at("play-plant").value, lang: window.arboledaPage.language })}`));
}

function broken(error) {
  console.error(error);
  broke = error;
  playing = false;
  const said = (window.arboledaPage?.words.js_broken ?? "{why}").replace("{why}", error.message);
  if (shell) shell.answer(said, false);
  else at("play-loading").textContent = said;
}

// Whether the plant goes on; a test does not wait for a page that broke.
function ready() {
  if (broke) throw broke;
  return playing;
}

// For a workbook, which may be read in another language; and for tests: what is asked of the plant without a button.
window.arboledaPlay = { leave, ask, ready, pause: () => play(false), advance: (ticks) => move("advance", { ticks }), clock: () => clock };
