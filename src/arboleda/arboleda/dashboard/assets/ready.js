// Makes a cell, or the whole plant, ready again: each act once the view says that the one before has ended.

import { onChange, value } from "./live.js";
import * as question from "./question.js";
import { answer, onAnswer, words } from "./shell.js";

const PATIENCE_MS = 120_000; // a homing may take a minute
let way = null; // what is under way: of a cell, or "" of the plant
let send = () => false;

export const named = (of) => of || words.plant;

export function start(how) {
  send = how;
  onChange(goOn);
  onAnswer((good) => good === false && end());
}

export function begin(of) {
  end();
  way = { of, stops: stops(), sent: new Set(), turn: 0 };
  goOn();
}

// A stop, or a refusal: what was said of that stays.
export function end() {
  const asks = way?.asks;
  clearTimeout(way?.timer);
  way = null;
  if (asks) question.dismiss();
}

function over(sentence, good) {
  end();
  answer(sentence, good);
}

const stops = () => JSON.stringify(value("list/stops"));

function due(of) {
  const list = of ? `ready.${of}` : "for_all";
  return value(`rows/${list}`)?.length ? value(`row/${list}/ready`).due : null;
}

function goOn() {
  if (!way) return;
  if (stops() !== way.stops) return over(words.ready_stopped, false);
  const next = due(way.of);
  const print = JSON.stringify(next);
  if (print === way.print) return;
  if (way.asks) question.dismiss(); // it was about what was due before
  Object.assign(way, { print, turn: way.turn + 1, asks: false });
  if (!next) return over(words.ready_done.replace("{of}", named(way.of)), true);
  if (next.kind === "hand") return over(next.says, false);
  const key = JSON.stringify([next.act, next.of, next.by_hand, next.arguments]);
  if (next.kind === "wait" || way.sent.has(key)) return wait(next.says);
  act(next, key);
}

function wait(says) {
  answer(says, null);
  clearTimeout(way.timer);
  way.timer = setTimeout(() => over(words.ready_late.replace("{why}", says), false), PATIENCE_MS);
}

async function act({ act, of, by_hand: byHand, arguments: told, asks, says }, key) {
  const [mine, turn] = [way, way.turn];
  clearTimeout(way.timer);
  for (const asked of asks) {
    way.asks = true;
    const yes = await question.confirmed(asked.replaceAll("{of}", named(of)));
    if (way !== mine || way.turn !== turn) return;
    way.asks = false;
    if (!yes) return over(words.ready_ended, null);
  }
  way.sent.add(key);
  wait(says);
  send(act, of, told ?? byHand);
}
