// The form of a kind: rows of facts and verbs as text, checked as each field is left, and read as the plant file has it.

import { box, draft, element } from "./make_state.js";
import { words } from "../shell.js";

const EFFECTS = ["motion", "process", "switch", "query"];
const TYPES = ["bool", "number", "int", "text"];
const ALSO = { boolean: "bool", integer: "int", float: "number", real: "number", string: "text", str: "text" };
const FACT = ["fact", "type"];
const VERB = ["verb", "effect", "with", "sets", "needs", "takes_s", "answers"];
const TAKES_S = "2"; // of a new verb, as a virtual device of a real one would
let made = 0;

export const addFact = (row = {}) => add("facts", FACT, row);
export const addVerb = (row = { takes_s: TAKES_S }) => add("verbs", VERB, row);

// Show a kind of the plant file, or an empty one.
export function show(kind) {
  box("facts").replaceChildren();
  box("verbs").replaceChildren();
  for (const [fact, type] of Object.entries(kind?.facts ?? {})) addFact({ fact, type: asText(type), origin: fact });
  for (const [verb, its] of Object.entries(kind?.verbs ?? {})) addVerb({ verb, origin: verb, ...mapped(its, asText) });
  if (!kind) addFact(), addVerb();
}

function add(where, keys, { origin = "", ...row }) {
  const around = element("div", "", { class: "make-form", "data-origin": origin });
  for (const key of keys) {
    const label = element("label", words[`make_key_${key}`]);
    const input = key === "effect" ? effects() : element("input", "", { type: "text", autocomplete: "off", maxlength: "200", placeholder: words[`make_like_${key}`] ?? "" });
    input.id = `make-${where}-${key}-${(made += 1)}`;
    input.value = row[key] ?? (key === "effect" ? EFFECTS[0] : "");
    if (key === "type") input.setAttribute("list", types());
    input.dataset.key = key;
    label.append(input);
    around.append(label);
  }
  box(where).append(around);
  return around;
}

function effects() {
  const select = element("select");
  select.append(...EFFECTS.map((each) => new Option(words[`make_effect_${each}`], each)));
  return select;
}

function types() {
  const id = "make-list-type";
  if (document.getElementById(id)) return id;
  const list = element("datalist", "", { id });
  list.append(...TYPES.map((each) => new Option(each)));
  document.getElementById("make").append(list);
  return id;
}

const rows = (where) => [...box(where).children].map((each) => ({ origin: each.dataset.origin, ...Object.fromEntries([...each.querySelectorAll("[data-key]")].map((input) => [input.dataset.key, input.value.trim()])) }));

// --- what the fields say, as the plant file has it

// The kind, of which `old` has what no field shows.
export function written(old) {
  const facts = rows("facts").filter(({ fact }) => fact).map(({ fact, type, origin }) => [fact, kept(type, old?.facts?.[origin]) ?? typed(type || "bool")]);
  const verbs = rows("verbs").filter(({ verb }) => verb).map((row) => [row.verb, verbOf(row, old?.verbs?.[row.origin] ?? {})]);
  return { ...old, facts: Object.fromEntries(facts), verbs: Object.fromEntries(verbs) };
}

const READ = { effect: (text) => text, with: (text) => mapped(parameters(text), typed), sets: (text) => pairs(text), needs: (text) => pairs(text), takes_s: Number, answers: (text) => (["number", "int"].includes(text.trim()) ? text.trim() : list(text)) };

function verbOf(row, old) {
  const verb = { ...old };
  for (const [key, read] of Object.entries(READ)) {
    if (kept(row[key], old[key]) !== undefined) continue;
    if (row[key]) verb[key] = read(row[key]);
    else delete verb[key];
  }
  return verb;
}

// A value whose text nobody has changed.
const kept = (text, value) => (value !== undefined && text === asText(value) ? value : undefined);

function asText(value) {
  if (Array.isArray(value)) return value.join(", ");
  if (value && typeof value === "object") return Object.entries(value).map(([name, each]) => `${name}: ${asText(each)}`).join(Object.values(value).some(Array.isArray) ? "; " : ", ");
  return `${value}`;
}

const mapped = (values, read) => Object.fromEntries(Object.entries(values).map(([name, each]) => [name, read(each)]));
export const plain = (text) => (text === "true" ? true : text === "false" ? false : text !== "" && Number.isFinite(Number(text)) ? Number(text) : text);
export const list = (text) => text.split(",").map((each) => plain(each.trim())).filter((each) => each !== "");

// "open, closed" is a list of words, anything else is a type.
const typed = (text) => (text.includes(",") ? list(text) : usual(text));
export const usual = (text) => ALSO[text.toLowerCase()] ?? text;

// "seconds: 1, 3, 5; gentle: bool", where one parameter without choices may end with a comma, too
const parameters = (text) => split(text, text.includes(";") ? /;/ : /,(?=[^:,]*:)|;/);
// "door: open, lit: true"
const pairs = (text) => mapped(split(text, /[,;]/), (value) => plain(value || "true"));
const split = (text, joint) => Object.fromEntries(text.split(joint).filter((each) => each.trim()).map((each) => [each.split(":")[0].trim(), each.split(":").slice(1).join(":").trim()]));

// --- where the plant file has what a field says

// [field, place] of each field of a row with a name; the type of a fact stands at its name.
export function fields(kind) {
  const of = (where, name) => [...box(where).children].flatMap((row) => [...row.querySelectorAll("[data-key]")].map((input) => [input, `kinds.${kind}.${where}.${row.querySelector(`[data-key=${name}]`).value.trim()}`]));
  return [...of("facts", "fact"), ...of("verbs", "verb").map(([input, at]) => [input, input.dataset.key === "verb" ? at : `${at}.${input.dataset.key}`])];
}

// Whether a device of a kind of the plant file is in other roles too: they change with it.
export const othersOf = (kind, cell, role) => Object.entries(draft.state.values.cells ?? {}).flatMap(([at, { devices }]) => Object.entries(devices ?? {}).filter(([each, device]) => device?.kind === kind && (at !== cell || each !== role)).map(([each]) => each));
