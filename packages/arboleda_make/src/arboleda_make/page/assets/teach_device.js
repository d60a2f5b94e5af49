// The controls of one device: its joints, axes of its tool, nodes, verbs, and the targets that it goes to.

import { aim, button, held, hold, letGo } from "./teach_press.js";

const words = window.arboledaPage.words;
const MOTIONS = ["x", "y", "z"];
const filled = (text, values) => text.replace(/\{(\w+)\}/g, (_, name) => values[name]);

// `step()` is null where a button goes on and on, else so many degrees or mm; `here` makes a target, in one of the
// `zones` if that is chosen.
export function draw(device, targets, zones, { step, here }) {
  const box = made("section", { className: "box teach-device" });
  box.setAttribute("aria-label", device.name);
  box.append(made("h3", { textContent: device.name === device.role ? device.name : `${device.name} (${device.role})` }));
  const line = made("p", { className: "hint" });
  const facts = made("p", { className: "hint" });
  box.append(line, facts);
  const state = { device, at: device.at };
  const rows = device.joints.map((joint, index) => axis(state, joint, index, step));
  box.append(...rows.map(({ row }) => row));
  if (device.axes) box.append(along(state, step));
  if (device.nodes) box.append(nodes(state));
  const chosen = device.joints.length || device.nodes ? places(state, targets, zones, here) : null;
  if (chosen) box.append(chosen.row);
  box.append(...verbs(device));
  return { box, show, offer: (found) => chosen?.offer(found) };

  function show(now) {
    state.at = now.at;
    line.textContent = [place(device, now.at), now.obstacle].filter(Boolean).join(" · ");
    facts.textContent = Object.entries(now.facts).map(([name, value]) => `${name}: ${said(value)}`).join(" · ");
    rows.forEach((row, index) => row.show(now.at?.[index]));
  }
}

const said = (value) => (value === true ? words.teach_yes : value === false ? words.teach_no : (value ?? "?"));

export function place(device, at) {
  if (at === null || at === undefined) return device.joints.length || device.nodes ? words.teach_nowhere : "";
  if (typeof at === "number") return filled(words.teach_node, { node: at });
  return device.joints.map(({ name, unit }, index) => `${name} ${at[index].toFixed(2)} ${unit}`).join(", ");
}

function axis(state, joint, index, step) {
  const row = made("div", { className: "teach-axis" });
  row.setAttribute("role", "group");
  row.setAttribute("aria-label", joint.name);
  const slider = made("input", { type: "range", min: joint.lower, max: joint.upper, step: 0.1 });
  slider.setAttribute("aria-label", filled(words.teach_slider, { joint: joint.name, unit: joint.unit }));
  const value = made("output");
  const side = (sign, text) => {
    const each = act(text, filled(words.teach_turn, { joint: joint.name, sign: text }));
    button(each, () => towards(state, joint, index, sign, step()), () => step() !== null);
    return each;
  };
  slide(slider, state, index);
  row.append(made("span", { textContent: joint.name }), side(-1, "−"), slider, side(1, "+"), value);
  return { row, show };

  function show(at) {
    value.textContent = at === undefined ? "?" : `${at.toFixed(2)} ${joint.unit}`;
    if (at !== undefined && !slider.matches(".held")) slider.value = at;
  }
}

function towards({ device, at }, { lower, upper }, index, sign, step) {
  if (!at) return null;
  const goal = [...at];
  const far = step === null ? (sign > 0 ? upper : lower) : goal[index] + sign * step;
  goal[index] = Math.min(Math.max(far, lower), upper);
  return { robot: device.name, goal };
}

// A slider moves its joint while it is held: by a pointer, or by a key that changes it.
function slide(slider, state, index) {
  const goal = () => state.at.map((each, other) => (other === index ? Number(slider.value) : each));
  const over = () => (slider.classList.remove("held"), letGo());
  slider.addEventListener("input", () => {
    if (!state.at) return;
    if (slider.matches(".held") && held()) return aim(goal());
    slider.classList.add("held");
    hold({ robot: state.device.name, goal: goal() });
  });
  for (const event of ["pointerup", "pointercancel", "keyup", "blur"]) slider.addEventListener(event, over);
}

function along({ device }, step) {
  const row = group("teach-along", words.teach_along);
  const frame = made("select");
  frame.setAttribute("aria-label", words.teach_frame);
  frame.append(new Option(words.teach_base, "base"), new Option(words.teach_tool, "tool"));
  row.append(frame);
  for (const axis of MOTIONS) {
    for (const sign of [-1, 1]) {
      const text = `${axis.toUpperCase()}${sign > 0 ? "+" : "−"}`;
      const each = act(text, filled(words.teach_tool_way, { axis: text }));
      const way = () => ({ axis, frame: frame.value, sign, ...(step() === null ? {} : { mm: step() }) });
      button(each, () => ({ robot: device.name, along: way() }), () => step() !== null);
      row.append(each);
    }
  }
  return row;
}

function nodes({ device }) {
  const row = group("teach-nodes", words.teach_nodes);
  row.style.setProperty("--columns", device.columns);
  for (let node = 0; node < device.nodes; node += 1) {
    const each = act(String(node), filled(words.teach_to_node, { node }));
    button(each, () => ({ robot: device.name, goal: node }));
    row.append(each);
  }
  return row;
}

function places({ device }, targets, zones, here) {
  const row = group("teach-places", words.teach_targets);
  const select = made("select");
  select.setAttribute("aria-label", words.teach_target);
  const name = made("input", { type: "text", maxLength: 60, placeholder: words.teach_new_target });
  name.setAttribute("aria-label", words.teach_new_target);
  const go = act(words.teach_go, words.teach_go_does);
  button(go, () => {
    const found = known.find((each) => each.name === select.value);
    return found && { robot: device.name, goal: found.at };
  });
  const approach = made("input", { type: "number", min: 0, step: 1, placeholder: words.teach_approach, className: "teach-approach" });
  approach.setAttribute("aria-label", words.teach_approach);
  const zone = made("select", { className: "teach-zone" });
  zone.setAttribute("aria-label", words.teach_zone);
  zone.append(new Option(words.teach_no_zone, ""), ...zones.map((each) => new Option(filled(words.teach_in_zone, { zone: each }), each)));
  const keep = act(words.teach_here, words.teach_here_does);
  const emptied = (done) => done && (name.value = zone.value = "");
  keep.addEventListener("click", () => here(device, name.value.trim() || select.value, approach.valueAsNumber, zone.value).then(emptied));
  const slides = device.joints.some(({ unit }) => unit === "mm");
  row.append(select, go, name, ...(slides ? [approach] : []), ...(zones.length ? [zone] : []), keep);
  let known = [];
  offer(targets);
  return { row, offer };

  function offer(found) {
    known = found.filter(({ robot }) => robot === device.name);
    const texts = known.map(({ name: of, draft }) => (draft ? filled(words.teach_drafted, { target: of }) : of));
    if (texts.join() === [...select.options].map(({ text }) => text).join()) return;
    const before = select.value;
    select.replaceChildren(...known.map(({ name: of }, index) => new Option(texts[index], of)));
    if (known.some(({ name: of }) => of === before)) select.value = before;
  }
}

function verbs(device) {
  const plain = [device.homes && device.joints.length && "home", device.holds && "grip", device.holds && "let_go"].filter(Boolean);
  const rows = [];
  if (plain.length) {
    const row = group("teach-verbs", words.teach_verbs);
    row.append(...plain.map((verb) => told(device, verb, words[`teach_${verb}`], [], verb !== "home")));
    rows.push(row);
  }
  for (const verb of device.verbs) {
    const row = group("teach-verbs", verb.name);
    const fields = verb.parameters.map(field);
    row.append(...fields.map(({ label }) => label), told(device, verb.name, verb.name, fields, false));
    rows.push(row);
  }
  return rows;
}

function told(device, verb, text, fields, alone) {
  const each = act(text, filled(words.teach_verb_does, { verb: text }));
  const values = () => Object.fromEntries(fields.map(({ name, value }) => [name, value()]));
  button(each, () => ({ robot: device.name, verb, values: values() }), () => alone);
  return each;
}

function field({ name, type, choices, lower, upper, first }) {
  const label = made("label", { textContent: name });
  const input = choices.length ? made("select") : made("input", { type: type === "str" ? "text" : "number", value: first });
  if (choices.length) input.append(...choices.map((each) => new Option(String(each))));
  else if (lower !== null) Object.assign(input, { min: lower, max: upper, step: type === "int" ? 1 : "any" });
  label.append(input);
  const value = () => (choices.length ? choices[input.selectedIndex] : type === "str" ? input.value : Number(input.value));
  return { name, label, value };
}

function group(className, label) {
  const row = made("div", { className });
  row.setAttribute("role", "group");
  row.setAttribute("aria-label", label);
  return row;
}

function act(text, does) {
  const each = made("button", { type: "button", className: "act teach-held", textContent: text, title: does });
  each.setAttribute("aria-label", does);
  return each;
}

const made = (name, values = {}) => Object.assign(document.createElement(name), values);
