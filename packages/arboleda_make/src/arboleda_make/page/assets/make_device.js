// Devices, new or changed: a form becomes a kind and a device with its driver in the plant file, as a person would
// write them; its cell is made with its first device.

import { onCells, read } from "./make_cells.js";
import * as kinds from "./make_kind.js";
import { ask, box, draft, element, fill, inWords, options, say, step } from "./make_state.js";
import { ended } from "./make_try.js";
import { words } from "../shell.js";

// The kinds that come with Arboleda, with the fields that each has here; no driver is offered for them.
const SHIPPED = { arm: ["model", "x_m", "y_m", "yaw_deg"], mobile: ["x_m", "y_m", "yaw_deg"], gripper: ["tool_of"], effector: ["tool_of"], conveyor: [], camera: ["answers"], sensor: ["answers"], person: [] };
const KEYS = ["model", "x_m", "y_m", "yaw_deg", "tool_of", "answers"];
let changing = null; // the cell and the role of the device that is changed
let drivers = null; // as the server has them, once this panel was open
let reading = null; // while, and once, they are asked for
let adds = ""; // what the button says of a new device

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  box("kind").addEventListener("change", chosen);
  box("device_cell").addEventListener("change", chosen);
  box("driver").addEventListener("change", () => drawDriver());
  box("device").addEventListener("focusout", ({ target }) => judge(target));
  onCells(offer);
  adds = document.querySelector("#make [data-make=add_device]").textContent;
  kinds.show(null);
}

const cellsOf = () => draft.state.values.cells ?? {};
const declaredKinds = () => draft.state.values.kinds ?? {};
const cell = () => box("device_cell").value || box("new_cell").value.trim();
const isShipped = (kind) => kind in SHIPPED && !(kind in declaredKinds());

function offer() {
  const first = box("device_cell").options.length ? box("device_cell").value : draft.cells[0]?.name;
  options(box("device_cell"), [...draft.cells.map(({ name }) => [name]), ["", words.make_new_cell]], first);
  const own = Object.keys(declaredKinds());
  const shipped = Object.keys(SHIPPED).filter((each) => !own.includes(each));
  const others = former() ? [former().kind].filter((each) => each && !own.includes(each) && !shipped.includes(each)) : [];
  options(box("kind"), [["", words.make_new_kind], ...[...own, ...others, ...shipped].map((each) => [each])]);
  chosen();
  offerDrivers();
}

const former = () => changing && cellsOf()[changing.cell]?.devices?.[changing.role];

function chosen() {
  const kind = box("kind").value;
  box("new_cell").closest("label").hidden = box("device_cell").value !== "";
  const isOwn = !kind || (changing !== null && kind in declaredKinds());
  box("kind-form").hidden = !isOwn;
  box("new_kind").closest("label").hidden = kind !== "";
  for (const key of KEYS) box(key).closest("label").hidden = !(isShipped(kind) && SHIPPED[kind].includes(key));
  const robots = Object.entries(cellsOf()[cell()]?.devices ?? {}).filter(([, device]) => ["arm", "mobile"].includes(device?.kind));
  options(box("tool_of"), [["", words.make_no_driver], ...robots.map(([role]) => [role])]);
  box("driver-form").hidden = isShipped(kind);
}

// --- a device that there is

// Fill the form with a device, to be changed.
async function change(at) {
  changing = at;
  const { kind, driver, ...device } = former();
  offer();
  box("device_cell").value = at.cell;
  box("role").value = at.role;
  box("kind").value = kind;
  chosen();
  const { origin_m: [x, y] = [], yaw_deg: yaw } = device.base ?? device.grid ?? {};
  const values = { ...device, x_m: x, y_m: y, yaw_deg: yaw, answers: device.answers?.join(", ") };
  for (const key of KEYS) box(key).value = values[key] ?? (key === "model" ? box(key).value : "");
  kinds.show(declaredKinds()[kind] ?? null);
  locked();
  document.querySelector('[data-make-panel="device"]').click();
  await offerDrivers();
  const name = driver && typeof driver === "object" ? Object.keys(driver)[0] : driver;
  box("driver").value = name ?? "";
  drawDriver(driver?.[name] ?? {});
  const others = kinds.othersOf(kind, at.cell, at.role);
  say(kind in declaredKinds() && others.length ? fill(words.make_kind_of_others, { kind, others: others.join(", ") }) : "");
}

// The form for a new device again.
function fresh() {
  changing = null;
  for (const key of ["role", "new_kind", "new_cell", ...KEYS]) if (key !== "model") box(key).value = "";
  kinds.show(null);
  box("driver").value = "";
  drawDriver();
  locked();
  offer();
}

function locked() {
  box("role").disabled = box("device_cell").disabled = changing !== null;
  const act = (name) => document.querySelector(`#make [data-make="${name}"]`);
  act("add_device").textContent = changing ? fill(words.make_change_device, changing) : adds;
  act("new_device").hidden = !changing;
}

// --- its driver

// The drivers, once somebody looks at this panel: some take a moment to be found.
function offerDrivers() {
  if (!box("device").hidden) reading ??= readDrivers();
  return reading;
}

async function readDrivers() {
  drivers = await ask(`/api/make/drivers?${new URLSearchParams({ language: window.arboledaPage.language })}`);
  if (!drivers) reading = null;
  options(box("driver"), [["", words.make_no_driver], ...(drivers ?? []).map(({ name }) => [name])]);
  drawDriver();
}

function drawDriver(values = {}) {
  const driver = drivers?.find(({ name }) => name === box("driver").value);
  box("driver-about").textContent = driver ? driver.why_not || driver.about : words.make_no_driver_about;
  box("settings").replaceChildren(...(driver?.keys ?? []).map((key) => setting(key, values[key.name])));
}

// A field for a key of a driver's settings, with its default and its meaning beside it.
function setting({ name, form, choices, required, default: usual, about }, value) {
  const id = `make-setting-${name}`;
  const label = element("label", name);
  const field = form === "choice" || form === "bool" ? element("select") : element(form === "yaml" ? "textarea" : "input", "", { rows: 2, spellcheck: "false", autocomplete: "off", placeholder: usual });
  if (field.tagName === "SELECT") field.append(...["", ...(form === "bool" ? ["true", "false"] : choices)].map((each) => new Option(each || usual || "-", each)));
  if (value !== undefined) field.value = typeof value === "object" ? JSON.stringify(value) : value;
  const without = required ? words.make_required : usual ? fill(words.make_default, { value: usual }) : "";
  const meaning = element("small", [about, without].filter(Boolean).join(". "), { id: `${id}-about` });
  for (const [key, text] of Object.entries({ id, "data-setting": name, "aria-describedby": meaning.id, "aria-required": String(required) })) field.setAttribute(key, text);
  label.append(field, meaning);
  return label;
}

const settings = () => Object.fromEntries([...box("settings").querySelectorAll("[data-setting]")].map((each) => [each.dataset.setting, each.value.trim()]).filter(([, text]) => text));

// --- what is pressed

function clicked({ target }) {
  const { make: act, makePanel, changeDevice, cell } = target.closest("button")?.dataset ?? {};
  if (makePanel === "device") offerDrivers();
  if (changeDevice) change({ cell, role: changeDevice });
  if (act === "add_fact") kinds.addFact().querySelector("input").focus();
  if (act === "add_verb") kinds.addVerb().querySelector("input").focus();
  if (act === "add_device") add();
  if (act === "new_device") fresh();
  if (act === "reach") reach();
}

async function add() {
  const device = await right();
  if (!device || !(await step("../make/device", device))) return;
  const said = fill(changing ? words.make_device_changed : words.make_device_added, { role: device.role, name: device.kind });
  await read();
  fresh();
  box("device_cell").value = device.cell;
  box("kind").value = device.kind;
  chosen();
  say(said);
}

// Have its driver listen for a moment, in a process of its own; the draft stays as it is.
async function reach() {
  const says = (sentence) => (box("reach-state").textContent = sentence);
  const device = await right(says);
  if (!device) return;
  says(words.make_reaching);
  if (!(await ask("/api/make/runs/reach", device, says))) return;
  const found = await ended("reach", () => {}, says);
  if (found) says(fill(found.reached ? words.make_reached : words.make_unreached, { role: device.role, ...found, facts: heard(found) }));
}

const heard = ({ facts, missing }) => [...Object.entries(facts).map(([fact, value]) => `${fact}: ${value}`), ...missing.map((fact) => fill(words.make_unsaid, { fact }))].join(", ");

// --- what the form says

// The device that the form says; a name that is still missing is made up where its fields are judged before.
function written(madeUp = "") {
  const known = box("kind").value;
  const kind = known || box("new_kind").value.trim() || madeUp;
  const driver = box("driver-form").hidden ? "" : box("driver").value;
  const declared = box("kind-form").hidden ? {} : { declared: kinds.written(known ? declaredKinds()[known] : undefined) };
  return { cell: cell() || madeUp, role: box("role").value.trim() || madeUp, kind, driver, settings: driver ? settings() : {}, keys: keys(kind), ...declared };
}

// Other keys of a kind that comes with Arboleda; what is empty is taken away.
function keys(kind) {
  if (!isShipped(kind)) return {};
  const { x_m: x, y_m: y, yaw_deg: yaw, answers, ...others } = Object.fromEntries(SHIPPED[kind].map((key) => [key, box(key).value.trim()]));
  const stands = x || y || yaw ? { origin_m: [Number(x), Number(y)], ...(Number(yaw) ? { yaw_deg: Number(yaw) } : {}) } : null;
  return { ...others, ...(x === undefined ? {} : { [kind === "arm" ? "base" : "grid"]: stands }), ...(answers === undefined ? {} : { answers: answers ? kinds.list(answers) : null }) };
}

// --- what is wrong with it, below the field that it is about

const MADE_UP = "new";
let asked = 0; // the last question about it
const shownFields = () => [...box("device").querySelectorAll("input, select, textarea")].filter((each) => each.offsetParent);

// The device that is right; null where it is not, and then the first wrong field has the focus.
async function right(says = say) {
  const wrong = await objections(says);
  if (!wrong) return null;
  for (const field of shownFields()) mark(field, wrong.get(field));
  const first = shownFields().find((field) => wrong.has(field));
  if (first) return says(wrong.get(first)), first.focus(), null;
  if (wrong.size) return says([...wrong.values()].join(" ")), null;
  return written();
}

// Say what is wrong with a field that somebody leaves; what is right by now of others is no longer said.
async function judge(left) {
  if (!left.matches("input, select") || left.dataset.setting) return;
  if (left.dataset.key === "type") left.value = kinds.usual(left.value.trim());
  const number = (asked += 1);
  const wrong = await objections();
  if (!wrong || number !== asked) return;
  if (left.value.trim()) mark(left, wrong.get(left));
  for (const field of shownFields()) if (!wrong.has(field)) mark(field, "");
}

// What is wrong by field: what `check` would refuse, and names that are there already. What it says of no field here
// has a key of its own.
async function objections(says = say) {
  const needed = shownFields().filter((field) => NAMES[field.id] && !field.value.trim());
  const device = written(MADE_UP);
  const found = await ask("/api/make/objections", device, says);
  if (!found) return null;
  const said = await inWords(found.map(({ sentence }) => sentence));
  const wrong = new Map();
  found.forEach((each, n) => {
    const field = fieldAt(each, device);
    wrong.set(field ?? each.sentence, field ? said[n].replace(`${each.place}: `, "") : said[n]);
  });
  for (const field of shownFields()) if (NAMES[field.id]?.(field.value.trim())) wrong.set(field, fill(words.make_known, { name: field.value.trim() }));
  for (const field of needed) wrong.set(field, words.make_required);
  return wrong;
}

// The field whose place in the plant file is the nearest to that of an objection.
function fieldAt({ place, sentence }, { cell: at, role, kind, driver }) {
  const device = `cells.${at}.devices.${role}`;
  const own = { new_cell: `cells.${at}`, role: device, kind: `${device}.kind`, new_kind: `kinds.${kind}`, x_m: `${device}.base`, driver: `${device}.driver` };
  const ofDriver = [...box("settings").querySelectorAll("[data-setting]")].map((field) => [field, `${device}.driver.${driver}.${field.dataset.setting}`]);
  const all = [...ofDriver, ...Object.entries({ ...own, ...Object.fromEntries(["model", "tool_of", "answers"].map((key) => [key, `${device}.${key}`])) }).map(([id, at]) => [box(id), at]), ...kinds.fields(kind)];
  const named = sentence.startsWith(`${place}: the name `);
  const near = all.filter(([field, at]) => field.offsetParent && (place === at || place.startsWith(`${at}.`) || place.startsWith(`${at}[`)) && !(field.dataset.key === "fact" && !named) && !(field.dataset.key === "type" && named));
  return near.sort(([, one], [, other]) => other.length - one.length)[0]?.[0];
}

function mark(field, sentence = "") {
  const label = field.closest("label");
  label.querySelector(".make-wrong")?.remove();
  if (sentence) label.append(element("small", sentence, { class: "make-wrong", role: "alert" }));
  field.setAttribute("aria-invalid", Boolean(sentence));
}

// A name that is there already would be changed by a form for what is new.
const NAMES = {
  "make-role": (text) => !changing && cellsOf()[cell()]?.devices?.[text] !== undefined,
  "make-new_kind": (text) => text in declaredKinds(),
  "make-new_cell": (text) => text in cellsOf(),
};
