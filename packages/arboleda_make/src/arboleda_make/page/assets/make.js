// Make: the draft of the plant's files, what differs, its check, and what leads to it: cells, tries, proofs, devices.

import * as cells from "./make_cells.js";
import * as device from "./make_device.js";
import * as proposals from "./make_proposals.js";
import * as proof from "./make_prove.js";
import * as tryout from "./make_try.js";
import { ask, box, draft, editor, element, fill, inWords, isMine, knownName, look, name, onDraft, say, spoken, step, take, there } from "./make_state.js";
import * as question from "../question.js";
import { all, words } from "../shell.js";

const CHECK_MS = 1200; // after the last change
const LOOK_MS = 5000; // what others do
const WAIT_MS = 1500; // while another check is under way, or too many wait
const PANEL = "arboleda_make_panel"; // where this browser tab was last, also before it looked at a record
const FIRST = "draft";
let shown = false;
let checked = null; // the digest of the draft that was checked last
let checking = false; // this page has asked, and waits
let timer = null;

export function start() {
  if (!there()) return;
  document.getElementById("make").addEventListener("click", clicked);
  onDraft(drawn);
  cells.start();
  tryout.start();
  proof.start();
  device.start();
  proposals.start();
  setInterval(() => shown && !document.hidden && look(), LOOK_MS);
}

export async function show(is) {
  shown = is && there();
  if (!shown) return;
  box("name").value ||= knownName();
  open(sessionStorage.getItem(PANEL) ?? FIRST);
  await look();
  if (draft.state?.is_ours === false) return;
  await proposals.look();
  await cells.read();
  tryout.recall();
  proof.recall();
}

const ACTS = {
  take,
  undo: () => step("undo").then(reread),
  redo: () => step("redo").then(reread),
  discard: async () => (await question.confirmed(words.make_discard)) && step("discard").then(reread),
  check: () => check(),
  keep,
  own: () => step("own").then((done) => done && reread()),
};

const reread = () => cells.read();

function clicked({ target }) {
  const { make: act, makePanel } = target.closest("button")?.dataset ?? {};
  ACTS[act]?.();
  if (makePanel) open(makePanel);
  if (makePanel === "proposals") proposals.look();
}

export function open(panel) {
  sessionStorage.setItem(PANEL, panel);
  all("[data-make-panel]").forEach((each) => each.setAttribute("aria-pressed", each.dataset.makePanel === panel));
  all(".make-panel").forEach((each) => (each.hidden = each.id !== `make-${panel}`));
}

function drawn() {
  const { state } = draft;
  box("not-ours").hidden = state.is_ours;
  const who = state.editor;
  const since = who && new Date(who.since).toLocaleTimeString();
  box("who").textContent = !who ? words.make_nobody : isMine() ? words.make_you : fill(words.make_other, { name: who.name, since });
  const taking = button("take");
  taking.textContent = who && !isMine() ? words.make_take_over : words.make_take;
  taking.hidden = isMine();
  button("undo").disabled = !state.undo;
  button("redo").disabled = !state.redo;
  button("keep").disabled = button("discard").disabled = !state.changes.length;
  if (state.changes.length) tell("changes");
  else lines("changes", [words.make_no_change]);
  for (const name of ["set_aside", "restart", "waiting"]) tell(name), (box(`${name}-box`).hidden = !state[name].length);
  bar();
  if (state.digest === checked) return;
  clearTimeout(timer);
  timer = setTimeout(check, CHECK_MS);
  lines("problems", [words.make_checking]);
}

const button = (act) => document.querySelector(`#make [data-make="${act}"]`);

// What the draft has under this name, unless it is another draft by the time that the words are there.
async function tell(name) {
  const { state } = draft;
  const said = await inWords(state[name]);
  if (draft.state === state) lines(name, said);
}

const lines = (id, rows) => box(id).replaceChildren(...rows.map((text) => element("li", text)));

// What `check` says of the draft; one at a time, and the last change counts.
async function check() {
  clearTimeout(timer);
  if (checking) return void (timer = setTimeout(check, WAIT_MS));
  checking = true;
  const found = await spoken(await ask("/api/draft/check", {}, () => {}));
  checking = false;
  if (!found) return void (timer = setTimeout(check, WAIT_MS));
  checked = found.digest;
  draft.problems = found.problems;
  marks(found);
  box("problems").append(...found.offers.map((offer) => offered(offer, found.digest)));
  bar();
}

// What the plant file could state and does not, with a button for each value; which one is so, a person knows.
function offered({ sentence, place, choices }, of) {
  const line = element("li", fill(words.make_offer, { sentence }), { "data-mark": "offer" });
  const acts = element("div", "", { class: "draw-acts" });
  for (const { text, value } of choices) {
    const made = element("button", text, { type: "button", class: "act" });
    made.addEventListener("click", () => stated(text, { place, value, of }));
    acts.append(made);
  }
  line.append(acts);
  return line;
}

const offerButtons = () => all("#make-problems button");

// Only who may change the draft can press what it offers.
function bar() {
  const { is_ours: isOurs, editor: who } = draft.state;
  offerButtons().forEach((each) => (each.disabled = !isOurs || (who !== null && !isMine())));
}

// An offer of another draft than the one that there is now is refused: then that one is checked.
async function stated(text, setting) {
  offerButtons().forEach((each) => (each.disabled = true));
  if (!(await step("set", setting))) return void (await look());
  say(fill(words.make_added, { name: text }));
  await reread();
}

export function marks({ problems, warnings }) {
  const rows = [...problems.map((text) => ["mistake", `✕ ${text}`]), ...warnings.map((text) => ["warning", `▲ ${text}`])];
  const made = rows.map(([sort, text]) => element("li", text, { "data-mark": sort }));
  box("problems").replaceChildren(...(made.length ? made : [element("li", words.make_good, { "data-mark": "good" })]));
  const tab = document.querySelector('[data-make-panel="draft"]');
  tab.dataset.mark = problems.length ? "mistake" : warnings.length ? "warning" : "";
  tab.title = problems.length ? fill(words.make_problems, { count: problems.length }) : "";
}

// The version, and when each cell takes it, or why only the next start does.
async function applied({ version, cells: taken, restart, cancelled }) {
  const said = await inWords(Object.values(taken));
  const when = Object.keys(taken).map((cell, n) => `${cell}: ${said[n]}`);
  const lost = cancelled.length ? [fill(words.make_cancelled, { tasks: cancelled.join(", ") })] : [];
  return [fill(words.make_kept, { version }), ...(restart.length ? [words.make_restart, ...restart] : when), ...lost].join(" ");
}

async function keep() {
  if (!(await question.confirmed([words.make_keep, ...(await inWords(draft.state.changes))].join("\n")))) return;
  say(words.make_checking);
  const kept = await spoken(await ask("/api/draft/apply", { editor: editor(), note: box("version-note").value.trim() }));
  if (!kept) return;
  marks(kept);
  say(kept.version === null ? words.make_not_kept : await applied(kept));
  if (kept.version === null) open("draft");
  else checked = null; // its offers are not in this answer
  await look();
  if (kept.restart.length) await offerRestart();
}

// What no cell can take while the plant runs: the plant restarts once all its cells rest, if that is wanted.
async function offerRestart() {
  const versions = await ask("/api/versions", null);
  if (!versions?.restart.can || !(await question.confirmed(words.make_restart_now))) return;
  const asked = await ask("/api/versions/restart", { name: name(), wanted: true });
  if (asked) say(words.make_restarting);
}
