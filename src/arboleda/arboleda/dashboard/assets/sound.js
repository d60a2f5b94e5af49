// A sound when a cell begins to need somebody, for whoever turned it on. Off at first; remembered by this browser.

import { value } from "./live.js";

const KEY = "arboleda_sound";
const NOTES = [880, 660, 880]; // Hz
const NOTE_S = 0.18;
const GAP_S = 0.06;
const LOUD = 0.25;
const words = window.arboledaPage.words;
let context = null;
let needed = null; // the cells that needed somebody when the last frame came; null before the first

const button = () => document.querySelector(".sound");
const isOn = () => remembered() === "on";

export function start() {
  button().addEventListener("click", toggle);
  // A browser lets no page sound before somebody has touched it.
  for (const touch of ["pointerup", "keydown"]) document.addEventListener(touch, () => isOn() && open().resume());
  if (isOn()) open();
  tell();
}

// What a frame says: only who was not there before is worth a sound, and nobody who was there when the page came.
export function hear() {
  const now = new Set((value("text/needs")?.[0] ?? "").split(" ").filter(Boolean));
  const isNew = needed !== null && [...now].some((cell) => !needed.has(cell));
  needed = now;
  if (isNew && isOn()) play();
}

async function toggle() {
  remember(isOn() ? "off" : "on");
  tell();
  if (!isOn()) return;
  await open().resume();
  play(); // so that it is known, and loud enough
}

function open() {
  if (context === null) {
    context = new AudioContext();
    context.addEventListener("statechange", tell);
  }
  return context;
}

function play() {
  if (open().state !== "running") return; // what could not sound when it happened would only puzzle later
  const begin = context.currentTime;
  NOTES.forEach((frequency, number) => {
    const at = begin + number * (NOTE_S + GAP_S);
    const tone = new OscillatorNode(context, { frequency });
    const loud = new GainNode(context, { gain: 0 });
    loud.gain.setValueAtTime(0, at);
    loud.gain.linearRampToValueAtTime(LOUD, at + 0.02);
    loud.gain.setValueAtTime(LOUD, at + NOTE_S - 0.04);
    loud.gain.linearRampToValueAtTime(0, at + NOTE_S);
    tone.connect(loud).connect(context.destination);
    tone.start(at);
    tone.stop(at + NOTE_S);
  });
}

function tell() {
  const state = !isOn() ? "off" : context?.state === "running" ? "on" : "waits";
  button().dataset.sound = state;
  button().setAttribute("aria-pressed", state !== "off");
  button().title = words[`sound_${state}`];
}

// A browser may keep nothing for a page: then the choice lasts as long as the page does.
let chosen = null;

function remembered() {
  if (chosen === null) {
    try {
      chosen = localStorage.getItem(KEY) ?? "off";
    } catch {
      chosen = "off";
    }
  }
  return chosen;
}

function remember(choice) {
  chosen = choice;
  try {
    localStorage.setItem(KEY, choice);
  } catch {
    return;
  }
}
