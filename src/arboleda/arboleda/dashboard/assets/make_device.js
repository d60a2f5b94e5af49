// New devices: a form becomes a kind and a device of the plant file, as a person would write them.

import { onCells, read } from "./make_cells.js";
import { box, draft, element, fill, options, say, step } from "./make_state.js";
import { words } from "./shell.js";

const NAME = /^[a-z][a-z0-9_]{0,31}$/;
const EFFECTS = ["motion", "process", "switch", "query"];
const TYPES = ["bool", "number", "int", "text"];
let made = 0;

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  box("kind").addEventListener("change", () => (box("kind-form").hidden = box("kind").value !== ""));
  onCells(offer);
  addFact();
  addVerb();
}

function offer() {
  options(box("device_cell"), draft.cells.map(({ name }) => [name]));
  const declared = Object.keys(draft.state.values.kinds ?? {});
  options(box("kind"), [["", words.make_new_kind], ...[...declared, "camera", "person"].map((each) => [each])]);
}

function clicked({ target }) {
  const act = target.closest("button")?.dataset.make;
  if (act === "add_fact") addFact().querySelector("input").focus();
  if (act === "add_verb") addVerb().querySelector("input").focus();
  if (act === "add_device") add();
}

const addFact = () => row("facts", [["fact", ""], ["type", "", TYPES]]);
const addVerb = () => row("verbs", [["verb", ""], ["effect", "", EFFECTS], ["takes_s", "2"], ["sets", ""], ["needs", ""], ["answers", ""]]);

function row(where, fields) {
  const around = element("div", "", { class: "make-form" });
  for (const [name, value, list] of fields) {
    const id = `make-${where}-${name}-${(made += 1)}`;
    const label = element("label", words[`make_key_${name}`]);
    const input = element("input", "", { type: "text", id, autocomplete: "off", maxlength: "200", placeholder: words[`make_like_${name}`] ?? "" });
    input.value = value;
    if (list) input.setAttribute("list", listOf(name, list));
    input.dataset.key = name;
    label.append(input);
    around.append(label);
  }
  box(where).append(around);
  return around;
}

function listOf(name, words) {
  const id = `make-list-${name}`;
  if (!document.getElementById(id)) {
    const list = element("datalist", "", { id });
    list.append(...words.map((each) => new Option(each)));
    document.getElementById("make").append(list);
  }
  return id;
}

const rows = (where) => [...box(where).children].map((each) => Object.fromEntries([...each.querySelectorAll("input")].map((input) => [input.dataset.key, input.value.trim()])));

async function add() {
  const [cell, role, kind] = [box("device_cell").value, box("role").value.trim(), box("kind").value];
  if (!NAME.test(role)) return say(words.make_role_first), box("role").focus();
  if (draft.state.values.cells?.[cell]?.devices?.[role]) return say(fill(words.make_known, { name: role }));
  const name = kind || box("new_kind").value.trim();
  if (!kind && !(await declare(name))) return;
  if (await step("set", { place: ["cells", cell, "devices", role], value: { kind: name } })) say(fill(words.make_device_added, { role, name })), read();
}

// Declare the kind that was written; false where its name is none, or the draft does not take it.
async function declare(name) {
  if (!NAME.test(name) || draft.state.values.kinds?.[name]) return say(words.make_kind_first), box("new_kind").focus(), false;
  const facts = Object.fromEntries(rows("facts").filter(({ fact }) => fact).map(({ fact, type }) => [fact, typed(type || "bool")]));
  const verbs = Object.fromEntries(rows("verbs").filter(({ verb }) => verb).map(({ verb, ...rest }) => [verb, verbOf(rest)]));
  return step("set", { place: ["kinds", name], value: { facts, verbs } });
}

// "open, closed" is a list of words, anything else is a type.
const typed = (text) => (text.includes(",") ? text.split(",").map((each) => plain(each.trim())) : text);

function verbOf({ effect, takes_s, sets, needs, answers }) {
  const value = { effect: effect || "switch" };
  if (sets) value.sets = pairs(sets);
  if (needs) value.needs = pairs(needs);
  if (answers) value.answers = answers.split(",").map((each) => plain(each.trim()));
  if (takes_s && value.effect !== "query" && Number.isFinite(Number(takes_s))) value.takes_s = Number(takes_s);
  return value;
}

// "door: open, lit: true"
const pairs = (text) => Object.fromEntries(text.split(",").map((each) => each.split(":").map((part) => part.trim())).map(([fact, value]) => [fact, plain(value ?? "true")]));

const plain = (text) => (text === "true" ? true : text === "false" ? false : text !== "" && Number.isFinite(Number(text)) ? Number(text) : text);
