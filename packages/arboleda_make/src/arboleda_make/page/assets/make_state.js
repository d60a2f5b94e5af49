// The draft as this page knows it, and the way of its steps to the server: one after the other, as one editor.

import { words } from "../shell.js";

// Since when this page edits the draft, here or by teaching; kept also where the page is opened anew.
const MINE = "arboleda_mine";

// `latest` is the recipe that was made or drawn last here: "cell recipe".
export const draft = { state: null, cells: [], faults: [], problems: [], latest: null };
const RUN = "arboleda_run_"; // what this browser tab has tried or proved since it changed the draft last
export const isRecent = (what) => sessionStorage.getItem(RUN + what) !== null;
export const begun = (what) => sessionStorage.setItem(RUN + what, "begun");
const changed = () => ["try", "prove"].forEach((what) => sessionStorage.removeItem(RUN + what));

const PANEL = "arboleda_make_panel"; // where this browser tab was last, also before it looked at a record
export const remember = (panel) => sessionStorage.setItem(PANEL, panel);
export const remembered = () => sessionStorage.getItem(PANEL);

const listeners = [];
const MOST_TRIES = 10;
const RETRY_MS = 300; // while the server takes no more in this second
let line = Promise.resolve();

export const box = (id) => document.getElementById(`make-${id}`);
export const onDraft = (listener) => listeners.push(listener);
// The sentence stands in each place where the draft is edited; a viewer has fewer.
export const say = (sentence) => document.querySelectorAll("#make-note, #draw-note").forEach((note) => (note.textContent = sentence ?? ""));
export const there = () => box("who") !== null;
export const fill = (text, values) => Object.entries(values).reduce((done, [name, value]) => done.replaceAll(`{${name}}`, value), text);

export function element(name, text = "", attributes = {}) {
  const made = Object.assign(document.createElement(name), { textContent: text });
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

// The id by which the server knows this page, as long as it is open.
export function editor() {
  let id = sessionStorage.getItem("arboleda_editor");
  if (!id) sessionStorage.setItem("arboleda_editor", (id = crypto.getRandomValues(new Uint32Array(4)).join("-")));
  return id;
}

const NAME = "arboleda_name";
export const knownName = () => localStorage.getItem(NAME) ?? "";
export const keepName = (name) => localStorage.setItem(NAME, name);
export const name = () => box("name").value.trim() || words.make_somebody;
export const isMine = () => draft.state?.editor != null && sessionStorage.getItem(MINE) === draft.state.editor.since;
export const isReading = () => draft.state?.editor != null && !isMine();

const FINDINGS = "/findings.json"; // says what was found in the language of the page
const ENGLISH = "en"; // in which everything is found
const { language } = window.arboledaPage;

// A GET without a body; null, and the sentence is shown, where it is refused.
export async function ask(path, body, shown = say) {
  try {
    for (let tries = 0; ; tries++) {
      const options = body && { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) };
      const got = await fetch(path, options);
      if (got.status === 429 && tries < MOST_TRIES) await new Promise((go) => setTimeout(go, RETRY_MS));
      else if (got.ok) return await got.json();
      else return shown(await refusal(path, await got.json())), null;
    }
  } catch {
    return shown(words.not_sent), null;
  }
}

const refusal = async (path, { sentence }) => (path.startsWith(FINDINGS) ? sentence : (await inWords([sentence]))[0]);

const MOST_KNOWN = 1000;
const known = new Map();

// Lines on what was found in files and runs, in the language of the page; in English where nobody here may ask for more.
export async function inWords(lines) {
  const missing = language === ENGLISH ? [] : [...new Set(lines.filter((line) => line && !known.has(line)))];
  if (missing.length) {
    const said = await ask(`${FINDINGS}?${new URLSearchParams({ lang: language })}`, { lines: missing }, () => {});
    if (known.size > MOST_KNOWN) known.clear();
    missing.forEach((line, n) => known.set(line, said?.lines[n] ?? line));
  }
  return lines.map((line) => known.get(line) ?? line);
}

const FOUND = ["about", "broken", "cause", "problems", "restart", "seen", "sentence", "title", "untrue", "warnings", "why"];

// An answer whose texts on what was found, those of these keys and `more`, are in the language of the page.
export async function spoken(answer, ...more) {
  const keys = new Set([...FOUND, ...more]);
  const each = (value, key, done) => {
    if (typeof value === "string") return keys.has(key) ? done(value) : value;
    if (Array.isArray(value)) return value.map((one) => each(one, key, done));
    if (!value || typeof value !== "object" || ["answers", "value"].includes(key)) return value; // their keys are of a recipe, or a plant file
    return Object.fromEntries(Object.entries(value).map(([name, one]) => [name, each(one, name, done)]));
  };
  const texts = [];
  each(answer, null, (text) => texts.push(text));
  const said = await inWords(texts);
  return each(answer, null, () => said.shift());
}

// One step of the draft; whoever edits nothing yet begins to. True if it was done.
export function step(path, body = {}) {
  const done = line.then(async () => {
    if (!draft.state?.editor && !(await take())) return false;
    const state = await ask(`/api/draft/${path}`, { ...body, editor: editor() });
    if (state) say(""), changed(), heard(state);
    return state !== null;
  });
  line = done.catch(() => {});
  return done;
}

export async function take() {
  const state = await ask("/api/draft/take", { editor: editor(), name: name() });
  if (!state) return false;
  sessionStorage.setItem(MINE, state.editor.since);
  keepName(box("name").value.trim());
  heard(state);
  return true;
}

export async function look() {
  const state = await ask("/api/draft");
  if (state) heard(state);
  return state !== null;
}

export function heard(state) {
  draft.state = state;
  for (const listener of listeners) listener();
}

export function options(select, rows, chosen = select.value) {
  select.replaceChildren(...rows.map(([value, text]) => new Option(text ?? value, value)));
  if (rows.some(([value]) => value === chosen)) select.value = chosen;
}
