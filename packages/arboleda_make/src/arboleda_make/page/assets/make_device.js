// New devices: a form becomes a kind and a device with its driver in the plant file, as a person would write them.

import { onCells, read } from "./make_cells.js";
import { ask, box, draft, element, fill, options, say, step } from "./make_state.js";
import { ended } from "./make_try.js";
import { words } from "../shell.js";

const NAME = /^[a-z][a-z0-9_]{0,31}$/;
const EFFECTS = ["motion", "process", "switch", "query"];
const TYPES = ["bool", "number", "int", "text"];
const SHIPPED = ["camera", "person"]; // kinds that no driver is for
let made = 0;
let drivers = null; // as the server has them, once this panel was open

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  box("kind").addEventListener("change", chosen);
  box("driver").addEventListener("change", drawDriver);
  onCells(offer);
  addFact();
  addVerb();
}

function offer() {
  options(box("device_cell"), draft.cells.map(({ name }) => [name]));
  const declared = Object.keys(draft.state.values.kinds ?? {});
  options(box("kind"), [["", words.make_new_kind], ...[...declared, ...SHIPPED].map((each) => [each])]);
  chosen();
  offerDrivers();
}

function chosen() {
  box("kind-form").hidden = box("kind").value !== "";
  box("driver-form").hidden = SHIPPED.includes(box("kind").value);
}

// The drivers, once somebody looks at this panel: some take a moment to be found.
async function offerDrivers() {
  if (drivers || box("device").hidden) return;
  drivers = [];
  drivers = await ask(`/api/make/drivers?${new URLSearchParams({ language: window.arboledaPage.language })}`);
  options(box("driver"), [["", words.make_no_driver], ...(drivers ?? []).map(({ name }) => [name])]);
  drawDriver();
}

function drawDriver() {
  const driver = drivers?.find(({ name }) => name === box("driver").value);
  box("driver-about").textContent = driver ? driver.why_not || driver.about : words.make_no_driver_about;
  box("settings").replaceChildren(...(driver?.keys ?? []).map(setting));
}

// A field for a key of a driver's settings, with its default and its meaning beside it.
function setting({ name, form, choices, required, default: usual, about }) {
  const id = `make-setting-${name}`;
  const label = element("label", name);
  const field = form === "choice" || form === "bool" ? element("select") : element(form === "yaml" ? "textarea" : "input", "", { rows: 2, spellcheck: "false", autocomplete: "off", placeholder: usual });
  if (field.tagName === "SELECT") field.append(...["", ...(form === "bool" ? ["true", "false"] : choices)].map((each) => new Option(each || usual || "-", each)));
  const without = required ? words.make_required : usual ? fill(words.make_default, { value: usual }) : "";
  const meaning = element("small", [about, without].filter(Boolean).join(". "), { id: `${id}-about` });
  for (const [key, value] of Object.entries({ id, "data-setting": name, "aria-describedby": meaning.id, "aria-required": String(required) })) field.setAttribute(key, value);
  label.append(field, meaning);
  return label;
}

const settings = () => Object.fromEntries([...box("settings").querySelectorAll("[data-setting]")].map((each) => [each.dataset.setting, each.value.trim()]).filter(([, text]) => text));

function clicked({ target }) {
  const { make: act, makePanel } = target.closest("button")?.dataset ?? {};
  if (makePanel === "device") offerDrivers();
  if (act === "add_fact") addFact().querySelector("input").focus();
  if (act === "add_verb") addVerb().querySelector("input").focus();
  if (act === "add_device") add();
  if (act === "reach") reach();
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
  const device = written();
  if (!device) return;
  const { cell, role, kind } = device;
  if (draft.state.values.cells?.[cell]?.devices?.[role]) return say(fill(words.make_known, { name: role }));
  if (!(await step("../make/device", device))) return;
  say(fill(words.make_device_added, { role, name: kind }));
  await read();
  box("kind").value = kind;
  chosen();
}

// Have its driver listen for a moment, in a process of its own; the draft stays as it is.
async function reach() {
  const device = written();
  if (!device) return;
  const says = (sentence) => (box("reach-state").textContent = sentence);
  says(words.make_reaching);
  if (!(await ask("/api/make/runs/reach", device, says))) return;
  const found = await ended("reach", () => {}, says);
  if (found) says(fill(found.reached ? words.make_reached : words.make_unreached, { role: device.role, ...found, facts: heard(found) }));
}

const heard = ({ facts, missing }) => [...Object.entries(facts).map(([fact, value]) => `${fact}: ${value}`), ...missing.map((fact) => fill(words.make_unsaid, { fact }))].join(", ");

// The device that the form says; null, and it is said, where a name is missing.
function written() {
  const [cell, role, known] = [box("device_cell").value, box("role").value.trim(), box("kind").value];
  if (!NAME.test(role)) return say(words.make_role_first), box("role").focus(), null;
  const kind = known || box("new_kind").value.trim();
  if (!known && (!NAME.test(kind) || draft.state.values.kinds?.[kind])) return say(words.make_kind_first), box("new_kind").focus(), null;
  const driver = box("driver-form").hidden ? "" : box("driver").value;
  return { cell, role, kind, driver, settings: driver ? settings() : {}, ...(known ? {} : { declared: declared() }) };
}

function declared() {
  const facts = Object.fromEntries(rows("facts").filter(({ fact }) => fact).map(({ fact, type }) => [fact, typed(type || "bool")]));
  const verbs = Object.fromEntries(rows("verbs").filter(({ verb }) => verb).map(({ verb, ...rest }) => [verb, verbOf(rest)]));
  return { facts, verbs };
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
