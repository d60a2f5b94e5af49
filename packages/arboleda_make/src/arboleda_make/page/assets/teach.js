// The panel of who teaches a cell: begins and ends its manual mode, and shows its devices as they are.

import { open } from "./make.js";
import { fromTaught } from "./make_cells.js";
import { editor, inWords, keepName, knownName } from "./make_state.js";
import { answer, words } from "../shell.js";
import * as device from "./teach_device.js";
import * as press from "./teach_press.js";

const LOOK_MS = 500;
const KEY = "arboleda_teach";
const box = (id) => document.getElementById(`teach-${id}`);
let cell = null;
let drawn = new Map(); // the controls of each device, by name
let shape = "";
let timer = null;
let recipeLink = null; // stands in the note from the second target on
let told = null; // what the plant said last, if it is what the note says
let taught = null; // the targets that were made last, of one cell

export function start() {
  if (!document.getElementById("teach")) return;
  press.start(heard, mine);
  box("cell").addEventListener("change", ({ target }) => show(target.value));
  box("begin").addEventListener("click", begin);
  box("end").addEventListener("click", end);
  recipeLink = box("recipe");
  recipeLink?.addEventListener("click", recipe);
  recipeLink?.remove();
  for (const each of document.querySelectorAll("[data-step]")) each.addEventListener("click", () => choose(each));
}

// Show a cell, and look at it as long as this part is open.
export function show(named) {
  if (!document.getElementById("teach")) return;
  const chosen = named ?? cell ?? box("cell").value;
  if (chosen !== cell) (cell = chosen), (shape = ""), press.letGo();
  box("cell").value = cell;
  box("name").value ||= knownName();
  for (const each of document.querySelectorAll("[data-teach-cell]")) each.hidden = each.dataset.teachCell !== cell;
  clearInterval(timer);
  timer = setInterval(look, LOOK_MS);
  look();
}

export function leave() {
  clearInterval(timer);
  press.letGo();
}

// The session of this page, if it is the one that teaches.
function mine() {
  const kept = JSON.parse(sessionStorage.getItem(KEY) ?? "null");
  return kept?.cell === cell ? kept : null;
}

async function begin() {
  const name = box("name").value.trim();
  if (!name) return say(words.teach_name_first), box("name").focus();
  keepName(name);
  const said = await ask(`/api/cells/${encodeURIComponent(cell)}/teach`, { teacher: name });
  if (said) sessionStorage.setItem(KEY, JSON.stringify({ cell, session: said.act }));
  look();
}

async function end() {
  press.letGo();
  if (await ask(`/api/cells/${encodeURIComponent(cell)}/automatic`, {})) sessionStorage.removeItem(KEY);
  look();
}

async function look() {
  const of = cell;
  if (document.getElementById("part-teach").hidden) return leave();
  const said = await ask(`/api/teach/${encodeURIComponent(of)}`);
  if (!said || of !== cell) return;
  draw(said);
}

function draw({ teaching, refusal, devices, targets, zones, drafts }) {
  const isMine = teaching !== null && mine()?.session === teaching.session;
  box("begin").disabled = teaching !== null || refusal !== null;
  box("end").disabled = teaching === null;
  if (teaching === null && refusal) tell(refusal);
  const now = JSON.stringify([zones, ...devices.map(({ name, joints, verbs, nodes }) => [name, joints, verbs, nodes])]);
  if (now !== shape) build(devices, targets, zones);
  shape = now;
  for (const each of devices) drawn.get(each.name).show(each);
  for (const each of drawn.values()) each.offer(targets);
  for (const each of box("devices").querySelectorAll("button, input, select")) each.disabled = !isMine || (!drafts && each.matches(".teach-keep"));
}

function build(devices, targets, zones) {
  const acts = { step, here };
  drawn = new Map(devices.map((each) => [each.name, device.draw(each, targets, zones, acts)]));
  box("devices").replaceChildren(...[...drawn.values()].map((each) => each.box));
}

function choose(chosen) {
  for (const each of document.querySelectorAll("[data-step]")) each.setAttribute("aria-pressed", each === chosen);
}

function step() {
  const chosen = document.querySelector('[data-step][aria-pressed="true"]').dataset.step;
  return chosen === "hold" ? null : Number(chosen);
}

function heard({ sentence, teaching, robot }, { number }, unseen) {
  if (sentence) return tell(sentence);
  if (robot) drawn.get(robot.name)?.show(robot);
  if (!teaching) return say(words.teach_over);
  if (teaching.number === number) say("");
  else if (teaching.trouble) tell(teaching.trouble);
  else if (unseen) say(words.teach_unseen);
}

async function here({ name }, target, approach, zone) {
  const person = box("name").value.trim();
  const how = { zone, ...(Number.isFinite(approach) ? { approach_mm: approach } : {}) };
  const said = await ask(`/api/teach/${encodeURIComponent(cell)}/here`, { robot: name, target, editor: editor(), name: person, ...how });
  if (!said) return said;
  taught = { cell, targets: [...(taught?.cell === cell ? taught.targets : []).filter((each) => each !== target), target].slice(-2) };
  say(words.teach_made.replace("{target}", target)), look();
  const draft = await ask("/api/draft");
  if (draft?.editor) sessionStorage.setItem("arboleda_mine", draft.editor.since); // as Make of this page asks for it
  return said;
}

function recipe() {
  fromTaught(taught);
  open("cells");
}

async function ask(path, body) {
  try {
    const options = body && { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) };
    const got = await fetch(path, options);
    const said = await got.json();
    if (got.ok) return said;
    tell(said.sentence);
  } catch {
    answer(words.not_sent, false);
  }
  return null;
}

// What the plant says, in the language of the page, unless something else is said before that is known.
async function tell(sentence) {
  if (sentence === told) return;
  told = sentence;
  const [line] = await inWords([sentence]);
  if (told === sentence) say(line), (told = sentence);
}

function say(sentence) {
  told = null;
  const offered = recipeLink && taught?.cell === cell && taught.targets.length > 1;
  box("note").replaceChildren(sentence, ...(offered ? [" ", recipeLink] : []));
}
