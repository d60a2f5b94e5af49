// The form of the chosen node: a field for each value, by choice where there is one, and what the check says of it.

import { edit } from "./draw.js";
import { titleOf } from "./draw_rows.js";
import * as twin from "./draw_twin.js";
import { kindOf, node, state, tree } from "./draw_state.js";
import { words } from "../shell.js";

const MORE = ["_skipIf", "_failureIf", "_successIf", "_while", "_onSuccess", "_onFailure", "_onHalted", "_post", "_description", "_autoremap"];
const VARIABLE = /^\$?\{.*\}$/;
const WHOLE = ["int", "unsigned", "msec"];
const NUMBERS = [...WHOLE, "double"];
const STATUSES = ["SUCCESS", "FAILURE", "SKIPPED"];
const asVariable = new Set(); // "tree path name" of fields that are to become variables
let added = null; // the name of an attribute that has no value yet
let made = 0;
let drawnFor = ""; // the node whose form this is

const box = (id) => document.getElementById(`draw-${id}`);
const key = (name) => `${state.tree} ${state.path} ${name}`;

export function start() {
  box("fields").addEventListener("change", changed);
  twin.start((name, value) => {
    set(name, value);
    box("fields").querySelector(`[data-port="${CSS.escape(name)}"]`)?.focus();
  });
  box("fields").addEventListener("click", ({ target }) => {
    const name = target.closest("[data-variable]")?.dataset.variable;
    if (!name) return;
    if (!asVariable.delete(key(name))) asVariable.add(key(name));
    if (VARIABLE.test(node().attributes[name] ?? "")) set(name, "");
    draw();
    box("fields").querySelector(`[data-port="${CSS.escape(name)}"]`)?.focus();
  });
}

function changed({ target }) {
  const { port } = target.dataset;
  target.dataset.was = target.value;
  if (target.dataset.more !== undefined && target.value) return (added = target.value), draw(), box("fields").querySelector(`[data-port="${CSS.escape(target.value)}"]`)?.focus();
  if (port) set(port, target.value, target.dataset.braces !== undefined);
}

function set(name, value, braces = false) {
  const { path } = state;
  const text = braces && value && !VARIABLE.test(value) ? `{${value}}` : value;
  if (added === name) added = null;
  edit(() => (node(path) ? { do: "set_attribute", tree: state.tree, path, name, value: text === "" ? null : text } : null));
}

export function draw() {
  const chosen = node();
  const held = inHand();
  if (drawnFor !== key("")) twin.close();
  drawnFor = key("");
  box("title").textContent = chosen ? titleOf(chosen).filter(Boolean).join(" · ") : words.draw_none;
  const kind = chosen && kindOf(chosen.kind);
  box("about").textContent = kind?.about ?? "";
  const marks = state.now.marks.filter(({ tree: of, path }) => of === state.tree && path === state.path);
  box("marks").replaceChildren(...(chosen ? marks : []).map(markItem));
  box("fields").replaceChildren(...(chosen ? fields(chosen, kind, marks) : []));
  if (held) handBack(held);
  drawParameters();
}

// The field that has the focus, and what somebody has begun to write there; the form is made anew around it.
function inHand() {
  const found = document.activeElement;
  if (!box("fields").contains(found)) return null;
  const [name, value] = ["port", "variable", "more", "fromTwin"].map((each) => [each, found.dataset[each]]).find((each) => each[1] !== undefined) ?? [];
  if (!name) return null;
  const begun = found.dataset.was !== undefined && found.dataset.was !== found.value ? found.value : null;
  return { selector: `[data-${name === "fromTwin" ? "from-twin" : name}="${CSS.escape(value)}"]`, begun, path: key("") };
}

function handBack({ selector, begun, path }) {
  const found = box("fields").querySelector(selector);
  if (begun !== null && found && path === key("")) found.value = begun;
  found?.focus();
}

export function markItem({ sentence, mistake, line }) {
  const item = Object.assign(document.createElement("li"), { textContent: `${mistake ? "✕" : "▲"} ${sentence}` });
  item.dataset.mark = mistake ? "mistake" : "warning";
  item.title = `${words.draw_line} ${line}`;
  return item;
}

function fields({ attributes, kind: name }, kind, marks) {
  const ports = kind?.ports ?? (name === "SubTree" ? subtreePorts(attributes.ID) : []);
  const known = ports.map((port) => port.name);
  const others = Object.keys(attributes).filter((each) => each !== "name" && !known.includes(each));
  if (added && !others.includes(added)) others.push(added);
  const rest = others.map((each) => ({ name: each, type: "", way: "input", words: [] }));
  const shown = [...ports, ...rest].map((port) => field(port, attributes[port.name], marks));
  return [...shown, field({ name: "name", label: words.draw_called, words: [] }, attributes.name, marks), more(others)];
}

// A SubTree takes the tree that it stands for, and what that takes.
function subtreePorts(id) {
  const { trees } = state.now;
  const inner = trees.find(({ name }) => name === id)?.parameters ?? [];
  return [{ name: "ID", words: trees.map(({ name }) => name), needed: true }, ...inner.map(({ name }) => ({ name, type: "", words: [] }))];
}

function field(port, value, marks) {
  const line = Object.assign(document.createElement("div"), { className: "draw-field" });
  const id = `draw-field-${(made += 1)}`;
  const label = Object.assign(document.createElement("label"), { htmlFor: id, textContent: `${port.label ?? port.name}${port.needed ? " *" : ""}` });
  const variable = VARIABLE.test(value ?? "") || asVariable.has(key(port.name)) || port.way === "output";
  const input = variable ? variableInput(value) : choices(port) ? choice(port, value) : plain(port, value);
  input.id = id;
  Object.assign(input.dataset, { port: port.name, was: input.value });
  if (marks.some(({ attribute }) => attribute === port.name)) input.setAttribute("aria-invalid", "true");
  line.append(label, input);
  if (port.way === "input" && (choices(port) || NUMBERS.includes(port.type))) line.append(toggle(port.name, variable));
  if (!variable && twin.isTarget(port)) line.append(twin.button(port));
  const about = [port.about, port.default && `${words.draw_default} ${port.default}`].filter(Boolean).join("; ");
  if (about) describe(line, input, about, id);
  return line;
}

function describe(line, input, about, id) {
  const text = Object.assign(document.createElement("small"), { id: `${id}-about`, textContent: about });
  input.setAttribute("aria-describedby", text.id);
  line.append(text);
}

function choices({ words: list, type }) {
  if (type === "bool") return ["true", "false"];
  if (type === "status") return STATUSES;
  return list?.length ? list : null;
}

function choice(port, value) {
  const select = document.createElement("select");
  const known = choices(port);
  const strange = value !== undefined && !known.includes(value) ? [value] : [];
  select.append(new Option("–", ""), ...[...known, ...strange].map((each) => new Option(each, each)));
  select.value = value ?? "";
  return select;
}

function plain({ type, lower, upper }, value) {
  const input = document.createElement("input");
  const isNumber = NUMBERS.includes(type) && (value === undefined || value.trim() === "" || Number.isFinite(Number(value)));
  input.type = isNumber ? "number" : "text";
  if (isNumber) Object.assign(input, { step: WHOLE.includes(type) ? 1 : "any", min: lower ?? "", max: upper ?? "" });
  input.value = value ?? "";
  return input;
}

function variableInput(value) {
  const input = Object.assign(document.createElement("input"), { type: "text", value: value ?? "", placeholder: "{ }" });
  input.dataset.braces = "";
  input.setAttribute("list", "draw-variables");
  return input;
}

function toggle(name, variable) {
  const button = Object.assign(document.createElement("button"), { type: "button", className: "tool", textContent: "{ }", title: words.draw_variable });
  button.dataset.variable = name;
  button.setAttribute("aria-pressed", variable);
  button.setAttribute("aria-label", `${name}: ${words.draw_variable}`);
  return button;
}

function more(there) {
  const select = document.createElement("select");
  select.dataset.more = "";
  select.setAttribute("aria-label", words.draw_more);
  select.append(new Option(words.draw_more, ""), ...MORE.filter((each) => !there.includes(each)).map((each) => new Option(each, each)));
  return select;
}

function drawParameters() {
  const shown = (tree()?.parameters ?? []).map(({ name }) => {
    const button = Object.assign(document.createElement("button"), { type: "button", className: "choice", textContent: `{${name}} ×`, title: words.draw_remove_parameter });
    button.setAttribute("aria-label", `${words.draw_remove_parameter}: ${name}`);
    button.dataset.drawParameter = name;
    return button;
  });
  const list = Object.assign(document.createElement("datalist"), { id: "draw-variables" });
  const used = (tree()?.nodes ?? []).flatMap(({ attributes }) => Object.values(attributes)).filter((each) => VARIABLE.test(each));
  const known = new Set([...(tree()?.parameters ?? []).map(({ name }) => `{${name}}`), ...used]);
  list.append(...[...known].map((each) => new Option(each, each)));
  const held = box("parameters").contains(document.activeElement);
  box("parameters").replaceChildren(...shown, list);
  if (held) (shown[0] ?? box("name")).focus();
}
