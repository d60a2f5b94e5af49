// Make: the draft of the plant's files, what differs, its check, and what leads to it: cells, tries, proofs, devices.

import * as cells from "./make_cells.js";
import * as device from "./make_device.js";
import * as proposals from "./make_proposals.js";
import * as proof from "./make_prove.js";
import * as tryout from "./make_try.js";
import { ask, box, draft, editor, element, fill, inWords, isMine, isReading, knownName, look, name, onDraft, remember, remembered, say, spoken, step, take, there } from "./make_state.js";
import { keepingFocus } from "../live.js";
import * as question from "../question.js";
import { all, words } from "../shell.js";

const CHECK_MS = 1200; // after the last change
const LOOK_MS = 5000; // what others do
const WAIT_MS = 1500; // while another check is under way, or too many wait
const FIRST = "draft";
let shown = false;
let watched = false; // its trees are drawn
let checked = null; // the digest of the draft whose check is shown
let latest = null; // that check
let offers = new Map(); // by its text, the step of each offer of the last check
let pressed = null; // the text of an offer that was pressed just as the draft changed
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
  setInterval(() => (shown || watched) && !document.hidden && look(), LOOK_MS);
}

export const watch = (is) => (watched = is && there());

export async function show(is) {
  shown = is && there();
  if (!shown) return;
  box("name").value ||= knownName();
  open(remembered() ?? FIRST);
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
  remember(panel);
  all("[data-make-panel]").forEach((each) => each.setAttribute("aria-pressed", each.dataset.makePanel === panel));
  all(".make-panel").forEach((each) => (each.hidden = each.id !== `make-${panel}`));
}

function drawn() {
  const { state } = draft;
  box("not-ours").hidden = state.is_ours;
  const who = state.editor;
  const since = who && new Date(who.since).toLocaleTimeString();
  const said = !who ? words.make_nobody : isMine() ? words.make_you : fill(words.make_other, { name: who.name, since });
  all("#make-who, #draw-who").forEach((each) => (each.textContent = said));
  for (const taking of all('[data-make="take"]')) {
    taking.textContent = isReading() ? words.make_take_over : words.make_take;
    taking.hidden = isMine();
  }
  keepingFocus(() => {
    button("undo").disabled = !state.undo;
    button("redo").disabled = !state.redo;
    button("keep").disabled = button("discard").disabled = !state.changes.length;
  });
  if (state.changes.length) tell("changes");
  else lines("changes", [words.make_no_change]);
  for (const name of ["set_aside", "restart", "waiting"]) tell(name), (box(`${name}-box`).hidden = !state[name].length);
  bar();
  if (state.digest === checked) return;
  checked = null; // also for the draft to which a step back leads
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
  if (checking) return again();
  checking = true;
  const found = await spoken(await ask("/api/draft/check", {}, () => {}));
  checking = false;
  if (found && found.digest !== draft.state.digest) await look(); // it was changed meanwhile, here or elsewhere
  if (found?.digest !== draft.state.digest) return again();
  clearTimeout(timer);
  checked = found.digest;
  latest = found;
  draft.problems = found.problems;
  marks(found);
  offer(found);
  if (offers.has(pressed)) stated(pressed);
  pressed = null;
}

function again() {
  clearTimeout(timer);
  timer = setTimeout(check, WAIT_MS);
}

// What the plant file could state and does not, with a button for each value; which one is so, a person knows. Buttons
// that are offered again stay, for somebody may be pressing one.
function offer({ digest: of, offers: found }) {
  const choices = found.flatMap(({ place, choices }) => choices.map(({ text, value }) => [text, { place, value, of }]));
  offers = new Map(choices);
  const shown = JSON.stringify(found);
  if (box("offers").dataset.shown !== shown) box("offers").replaceChildren(...found.map(offered));
  box("offers").dataset.shown = shown;
  bar();
}

function offered({ sentence, choices }) {
  const line = element("li", fill(words.make_offer, { sentence }), { "data-mark": "offer" });
  const acts = element("div", "", { class: "draw-acts" });
  for (const { text } of choices) {
    const made = element("button", text, { type: "button", class: "act" });
    made.addEventListener("click", () => stated(text));
    acts.append(made);
  }
  line.append(acts);
  return line;
}

// Who reads while somebody else edits can press nothing that changes the draft, nor end what the other one tries.
function bar() {
  all("#make fieldset, #draw fieldset").forEach((each) => (each.disabled = isReading()));
  all("#make-offers button").forEach((each) => (each.disabled = isReading() || !draft.state.is_ours));
}

// An offer of a draft that has changed since is refused. It counts all the same if the next check makes it, too.
async function stated(text) {
  const setting = offers.get(text);
  all("#make-offers button").forEach((each) => (each.disabled = true));
  if (!(await step("set", setting))) {
    await look();
    if (setting.of !== draft.state.digest) pressed = text;
    return;
  }
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

// Says first what the check, the last try and the last proof of this draft found; asks twice where one found it broken.
async function keep() {
  say(words.make_checking);
  const found = checked === draft.state.digest ? latest : await spoken(await ask("/api/draft/check", {}));
  if (!found) return;
  if (found.problems.length) return marks(found), open("draft"), say(words.make_not_kept);
  say("");
  const [tried, proved] = [tryout.verdict(), proof.verdict()];
  const verdicts = [checkVerdict(found), tried?.text ?? words.make_untried, proved?.text ?? words.make_unproved];
  const changes = await inWords(draft.state.changes);
  if (!(await question.confirmed([words.make_keep, ...changes, "", ...verdicts].join("\n")))) return;
  const broken = [tried, proved].filter((each) => each?.isBroken).map(({ text }) => text);
  if (broken.length && !(await question.confirmed([words.make_keep_broken, ...broken].join("\n")))) return;
  await apply();
}

function checkVerdict({ warnings }) {
  return warnings.length ? [fill(words.make_warnings, { count: warnings.length }), ...warnings.map((text) => `▲ ${text}`)].join("\n") : words.make_good;
}

async function apply() {
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
