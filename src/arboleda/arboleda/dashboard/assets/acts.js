// From a click to the plant: what a button asks for goes through the socket; a stop goes over HTTP as well.

import { value } from "./live.js";
import * as question from "./question.js";
import * as ready from "./ready.js";
import { answer } from "./shell.js";

const PATIENCE_MS = 3000;
const SECOND_WAY_MS = 300;
const HELD_MS = 800; // longer than a key that closes a question is pressed
const words = window.arboledaPage.words;
let scope = "";
let stopOf = (of) => (of ? `cells/${encodeURIComponent(of)}` : "plant");

export const setScope = (chosen) => (scope = chosen);
export const connected = () => Boolean(window.socket?.connected && window.did_handshake);

// `stops` says below which address of the API something is stopped, where that is no plant's.
export function start(stops = stopOf) {
  stopOf = stops;
  question.start();
  ready.start(send);
  document.getElementById("stop").addEventListener("click", () => stop(""));
  stopByHeldKey();
  document.addEventListener("click", (event) => {
    const button = event.target.closest("[data-act]");
    if (button) press(button);
  });
  window.socket.on("disconnect", lost);
}

// A second way to stop, for whom no pointer is at hand: Escape, held. It works from every field and every question.
function stopByHeldKey() {
  const button = document.getElementById("stop");
  let timer = null;
  const letGo = () => {
    clearTimeout(timer);
    timer = null;
    button.classList.remove("held");
  };
  document.addEventListener("keydown", ({ key, repeat }) => {
    if (key !== "Escape" || repeat || timer) return;
    button.classList.add("held");
    timer = setTimeout(() => (letGo(), stop("")), HELD_MS);
  });
  document.addEventListener("keyup", ({ key }) => key === "Escape" && letGo());
  window.addEventListener("blur", letGo);
}

async function press(button) {
  const { act, byHand, arguments: told } = button.dataset;
  const of = button.dataset.of === "$scope" ? scope : button.dataset.of;
  if (act === "stop") return stop(of);
  if (act === "ready") return ready.begin(of);
  if (await sure(act, of, JSON.parse(button.dataset.asks ?? "[]"))) send(act, of, told ? JSON.parse(told) : byHand === "true");
}

// Whether a person has answered all questions before this act with yes: those of its button, and the one of its package.
async function sure(act, of, asked = []) {
  const own = window.arboledaPage.asks?.[act];
  for (const each of own ? [...asked, own] : asked) if (!(await question.confirmed(each.replaceAll("{of}", ready.named(of))))) return false;
  return true;
}

// A request that could not leave now is not kept for later: the plant may have changed by then.
// `more`: whether a person has done it by hand, or the arguments of the verb.
export function send(act, of, more = false) {
  if (!connected()) return answer(words.not_sent, false);
  window.emitEvent("arboleda", act, of, more);
  return true;
}

const open = new Map(); // requests without an outcome: number -> what takes the outcome
let count = 0;

// The outcome of a request: {sentence, good}. `good` is null for one that a person did not want after all.
export async function outcome(act, of, more) {
  if (!(await sure(act, of))) return { sentence: "", good: null };
  if (!connected()) return { sentence: words.not_sent, good: false };
  const number = ++count;
  window.emitEvent("arboleda", act, of, more, number);
  return new Promise((resolve) => open.set(number, resolve));
}

// An answer of the plant, to the request of that number if there is one. While its outcome is unknown all see it.
export function hear(sentence, good, number) {
  if (good === null || !open.has(number)) return answer(sentence, good);
  end(number, { sentence, good });
}

// Nothing more is said to a request.
export const over = (number) => end(number, { sentence: "", good: true });

function lost() {
  for (const number of [...open.keys()]) end(number, { sentence: words.no_outcome, good: false });
}

function end(number, told) {
  open.get(number)?.(told);
  open.delete(number);
}

// Over HTTP, which no stuck socket holds up; through the socket as well where that has no answer at once.
export async function stop(of) {
  const button = document.getElementById("stop");
  ready.end();
  question.dismiss();
  button.dataset.s = "asked";
  answer(words.stopping, false, true);
  const second = new SecondWay(of);
  try {
    const sent = await fetch(`/api/${stopOf(of)}/stop`, { method: "POST", keepalive: true, signal: AbortSignal.timeout(PATIENCE_MS) });
    second.forget();
    answer((await sent.json()).sentence ?? words.stop_heard, sent.ok, true);
  } catch {
    second.go();
    if (!isUnderWay()) answer(words.stop_lost, false, true);
  } finally {
    delete button.dataset.s;
  }
}

// The socket, once: a stop that came twice might come after somebody has cleared the first.
class SecondWay {
  constructor(of) {
    this.of = of;
    this.timer = setTimeout(() => this.go(), SECOND_WAY_MS);
  }

  go() {
    if (this.timer && connected()) window.emitEvent("arboleda", "stop", this.of, false);
    this.forget();
  }

  forget() {
    clearTimeout(this.timer);
    this.timer = null;
  }
}

const isUnderWay = () => ["stopping", "stopped", "partly", "unconfirmed"].includes(value("text/stop")?.[1]);
