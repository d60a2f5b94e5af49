// The form of a kind: rows of facts and verbs as text, checked as each field is left, and read as the plant file has it.

import { box, draft, element, fill } from "./make_state.js";
import { words } from "../shell.js";

export const NAME = /^[a-z](_?[a-z0-9]){0,31}$/;
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

const READ = { effect: (text) => text, with: (text) => mapped(parameters(text), typed), sets: (text) => pairs(text), needs: (text) => pairs(text), takes_s: Number, answers: (text) => list(text) };

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
const usual = (text) => ALSO[text.toLowerCase()] ?? text;

// "seconds: 1, 3, 5; gentle: bool", where one parameter without choices may end with a comma, too
const parameters = (text) => split(text, text.includes(";") ? /;/ : /,(?=[^:,]*:)|;/);
// "door: open, lit: true"
const pairs = (text) => mapped(split(text, /[,;]/), (value) => plain(value || "true"));
const split = (text, joint) => Object.fromEntries(text.split(joint).filter((each) => each.trim()).map((each) => [each.split(":")[0].trim(), each.split(":").slice(1).join(":").trim()]));

// --- what is wrong with a field; "" where nothing is

export function objection(input) {
  const row = Object.fromEntries([...input.closest(".make-form").querySelectorAll("[data-key]")].map((each) => [each.dataset.key, each.value.trim()]));
  const { key } = input.dataset;
  if (key === "type") input.value = usual(input.value.trim());
  return row[key] || key === "answers" ? (OBJECTIONS[key]?.(row[key], row) ?? "") : "";
}

const OBJECTIONS = {
  fact: nameObjection,
  verb: nameObjection,
  type: typeObjection,
  with: (text) => Object.entries(parameters(text)).map(([name, type]) => nameObjection(name) || typeObjection(type)).find(Boolean) ?? "",
  sets: (text, row) => Object.entries(pairs(text)).map(([fact, value]) => valueObjection(fact, value, parameters(row.with))).find(Boolean) ?? "",
  needs: (text) => Object.entries(pairs(text)).map(([fact, value]) => (fact.includes(".") ? "" : valueObjection(fact, value, {}))).find(Boolean) ?? "",
  takes_s: (text) => (Number(text) >= 0 ? "" : words.make_bad_number),
  answers: (text, { verb, effect }) => (verb && effect === "query" && list(text).length < 1 ? words.make_bad_answers : ""),
};

function nameObjection(text) {
  return NAME.test(text) ? "" : words.make_bad_name;
}

function typeObjection(text) {
  const several = text.includes(",") ? list(text) : null;
  return TYPES.includes(usual(text)) || (several?.length > 1 && new Set(several).size === several.length) ? "" : words.make_bad_type;
}

function valueObjection(fact, value, given) {
  const facts = Object.fromEntries(rows("facts").filter((row) => row.fact).map((row) => [row.fact, typed(row.type || "bool")]));
  if (!(fact in facts)) return fill(words.make_bad_fact, { fact, facts: Object.keys(facts).join(", ") || "–" });
  if (`${value}`.startsWith("$")) return value.slice(1) in given ? "" : fill(words.make_bad_parameter, { name: value.slice(1) });
  const type = facts[fact];
  const fits = Array.isArray(type) ? type.includes(value) : { bool: typeof value === "boolean", int: Number.isInteger(value), number: typeof value === "number" }[type] ?? true;
  return fits ? "" : fill(words.make_bad_value, { fact, allowed: Array.isArray(type) ? type.join(", ") : type === "bool" ? "true, false" : type });
}

// Whether a device of a kind of the plant file is in other roles too: they change with it.
export const othersOf = (kind, cell, role) => Object.entries(draft.state.values.cells ?? {}).flatMap(([at, { devices }]) => Object.entries(devices ?? {}).filter(([each, device]) => device?.kind === kind && (at !== cell || each !== role)).map(([each]) => each));
