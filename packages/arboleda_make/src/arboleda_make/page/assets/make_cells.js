// The cells of the draft: devices, targets with their numbers, recipes as trees, and new recipes.

import { showRecipe } from "./draw.js";
import { intoDraft } from "./draw_copy.js";
import { NEW } from "./draw_state.js";
import { ask, box, draft, element, fill, inWords, options, say, spoken, step } from "./make_state.js";
import * as place from "../place.js";
import { words } from "../shell.js";

const NAME = /^[a-z][a-z0-9_]{0,39}$/;
const APPROACH = "approach_mm";
const listeners = [];
let reading = null;

export const onCells = (listener) => listeners.push(listener);

export function start() {
  document.getElementById("make").addEventListener("click", clicked);
  box("cell-list").addEventListener("change", ({ target }) => target.dataset.place && set(target));
  for (const id of ["cell", "robot"]) box(id).addEventListener("change", offer);
}

// Read the cells anew, once for all who want it now.
export async function read() {
  reading ??= ask("/api/make/cells");
  const found = await reading;
  reading = null;
  if (!found) return;
  draft.cells = found.problems.length ? withDraft(found) : found.cells;
  draft.faults = await spoken(found.faults);
  offer();
  const problems = (await inWords(found.problems)).map((text) => element("li", `✕ ${text}`, { "data-mark": "mistake" }));
  const list = element("ul", "", { class: "draw-marks make-unread" });
  list.append(element("li", words.make_unread), ...problems);
  box("cell-list").replaceChildren(...(problems.length ? [list] : []), ...draft.cells.map(drawn));
  for (const listener of listeners) listener();
}

// The cells as they could be read last, with the devices that the draft has now, those marked that it is wrong about.
function withDraft({ cells, problems }) {
  const now = draft.state.values.cells ?? {};
  const unread = Object.keys(now).filter((name) => !cells.some((each) => each.name === name));
  const all = [...cells, ...unread.map((name) => ({ name, devices: [], targets: [], carriers: [], recipes: [] }))];
  const isWrong = (place) => problems.some((text) => text.includes(` ${place}.`) || text.includes(` ${place}:`));
  return all.map((cell) => {
    const written = now[cell.name]?.devices;
    if (!written) return cell;
    const before = new Map(cell.devices.map((each) => [each.role, each]));
    const devices = Object.entries(written).map(([role, device]) => {
      const kind = `${device?.kind ?? ""}`;
      return { role, kind, ...before.get(role), isWrong: !before.has(role) || isWrong(`cells.${cell.name}.devices.${role}`) || isWrong(`kinds.${kind}`) };
    });
    return { ...cell, devices };
  });
}

const chosen = () => draft.cells.find(({ name }) => name === box("cell").value);

function offer() {
  options(box("cell"), draft.cells.map(({ name }) => [name]));
  const cell = chosen();
  options(box("robot"), (cell?.carriers ?? []).map((each) => [each]));
  const robot = box("robot").value;
  const targets = (cell?.targets ?? []).filter(({ name, robots }) => robots.includes(robot) && name !== "home");
  options(box("start"), targets.filter(({ gives }) => gives).map(({ name }) => [name]));
  const ends = targets.filter(({ takes }) => takes).map(({ name }) => [name]);
  const other = ends.find(([each]) => each !== box("start").value);
  options(box("end"), ends, box("end").value || other?.[0]);
  chooseTaught(targets.map(({ name }) => name));
}

// The two targets that were taught last, once: a part goes from the first to the second.
function chooseTaught(known) {
  const taught = draft.taught;
  if (!taught || taught.cell !== box("cell").value || !taught.targets.every((each) => known.includes(each))) return;
  [box("start").value, box("end").value] = taught.targets;
  draft.taught = null;
}

// A recipe is to be made of targets that were taught: { cell, targets }.
export function fromTaught(taught) {
  draft.taught = taught;
}

const ACTS = {
  carry: async () => {
    const recipe = wanted();
    if (!recipe) return;
    const way = Object.fromEntries(["cell", "robot", "start", "end"].map((id) => [id, box(id).value]));
    if (!way.start || !way.end) return say(words.make_no_targets);
    if (await carried(recipe, way)) await shownIn(recipe, way.cell);
  },
  empty: async () => {
    const recipe = wanted();
    if (recipe && (await step("set_trees", { file: `${recipe}.xml`, text: NEW }))) await shownIn(recipe, box("cell").value);
  },
};

// The name that was written; what is no name of a recipe, or one that there is, is said.
function wanted() {
  const recipe = box("recipe").value.trim();
  const known = draft.cells.some(({ recipes }) => recipes.some(({ name }) => name === recipe));
  if (NAME.test(recipe) && !known) return recipe;
  say(known ? fill(words.make_known, { name: recipe }) : words.make_name_first);
  box("recipe").focus();
  return null;
}

const carried = (recipe, way) => step("../make/carry", { ...way, recipe });

async function shownIn(recipe, cell) {
  box("recipe").value = "";
  await read();
  say(fill(words.make_added, { name: recipe }));
  draw(cell, recipe);
}

function draw(cell, recipe) {
  draft.latest = `${cell} ${recipe}`;
  showRecipe(recipe);
  place.go({ tab: "draw", cell });
}

function clicked({ target }) {
  const pressed = target.closest("button");
  const { make: act, drawRecipe, outlineRecipe, copyRecipe, removeRecipe, removePlace, removeCell, removeDevice, removePython, newTarget, cell } = pressed?.dataset ?? {};
  ACTS[act]?.();
  if (drawRecipe) draw(cell, drawRecipe);
  if (outlineRecipe) outline(pressed, cell, outlineRecipe);
  if (copyRecipe) copy(cell, copyRecipe);
  if (removeRecipe) step("remove_trees", { file: removeRecipe }).then(read);
  if (removePlace) step("remove", { place: JSON.parse(removePlace) }).then(read);
  if (removeDevice) step("../make/remove", { cell, role: removeDevice }).then(read);
  if (removePython) unused(removePython);
  if (removeCell) step("../make/remove", { cell: removeCell }).then(read);
  if (newTarget) add(pressed, newTarget);
}

// A recipe in Python becomes a tree of the draft, called as the field says, or after the recipe.
async function copy(cell, recipe) {
  const taken = draft.cells.flatMap(({ recipes }) => recipes.map(({ name }) => name));
  const wanted = box("recipe").value.trim();
  const name = await intoDraft(cell, recipe, taken, wanted);
  if (name) await shownIn(name, cell);
}

function drawn({ name, devices, recipes }) {
  const made = element("section", "", { class: "box make-cell" });
  const heading = element("h2", name);
  const parts = devices.map((each) => deviceRow(name, each));
  if (draft.cells.length > 1) heading.append(" ", act(words.make_remove, { removeCell: name }, name));
  made.append(heading, element("h3", words.make_devices), list(parts), element("h3", words.make_recipes));
  made.append(list(recipes.map((each) => recipeRow(name, each))), element("h3", words.make_targets), targets(name));
  return made;
}

function deviceRow(cell, { role, kind, shared, isWrong }) {
  const made = element("li", "", isWrong ? { "data-mark": "mistake" } : {});
  made.append(element("strong", isWrong ? `✕ ${role}` : role), ` ${kind}${shared ? ` (${words.make_shared})` : ""} `);
  if (isWrong) made.append(element("span", words.make_is_wrong, { class: "make-wrong" }), " ");
  if (!draft.state.values.cells?.[cell]?.devices?.[role]) return made; // of an arm's cell, or gone
  if (!shared) made.append(act(words.make_change, { cell, changeDevice: role }, role), " ");
  made.append(act(words.make_remove, { cell, removeDevice: role }, role));
  return made;
}

// A button that says of what it is to whoever cannot see where it stands.
function act(text, data, of) {
  const button = element("button", text, { type: "button", class: "act", "aria-label": `${text}: ${of}` });
  Object.assign(button.dataset, data);
  return button;
}

function list(items) {
  const made = element("ul", "", { class: "make-lines" });
  made.append(...items);
  return made;
}

// Where the plant file uses a file of recipes in Python; null where it does not.
function usePlace(file) {
  const uses = draft.state.values.uses ?? [];
  const at = uses.findIndex((each) => `${each}`.split("/").pop() === file);
  return at < 0 ? null : uses.length > 1 ? ["uses", at] : ["uses"];
}

// All recipes of the file go; the file itself stays in its folder.
async function unused(file) {
  if (!(await step("remove", { place: usePlace(file) }))) return;
  say(fill(words.make_python_gone, { file }));
  await read();
}

function recipeRow(cell, { name, about, sort, file }) {
  const made = element("li");
  made.append(element("strong", name), ` ${about} `, element("span", words[`make_sort_${sort}`], { class: "make-sort" }), " ");
  const acts = sort === "drawn" ? [[words.make_draw, { drawRecipe: name }], [words.make_remove, { removeRecipe: file }]] : [[words.make_show, { outlineRecipe: name }], [words.make_copy, { copyRecipe: name }]];
  if (sort === "python" && usePlace(file)) acts.push([words.make_remove, { removePython: file }]);
  for (const [text, data] of acts) made.append(act(text, { cell, ...data }, name), " ");
  return made;
}

// The tree of a recipe that is not drawn, as an outline below it.
async function outline(button, cell, recipe) {
  const row = button.closest("li");
  const before = row.querySelector(".make-outline");
  if (before) return before.remove();
  const got = await fetch(`/api/make/recipe?${new URLSearchParams({ cell, recipe })}`);
  if (!got.ok) return say((await got.json()).sentence);
  const xml = new DOMParser().parseFromString(await got.text(), "application/xml");
  const trees = new Map([...xml.querySelectorAll("BehaviorTree")].map((tree) => [tree.getAttribute("ID"), tree]));
  const main = trees.get(xml.documentElement.getAttribute("main_tree_to_execute"));
  const made = nested(main, trees);
  made.classList.add("make-outline");
  row.append(made);
}

function nested(node, trees) {
  const made = element("ul");
  for (const child of node.children) {
    const inner = child.tagName === "SubTree" ? trees.get(child.getAttribute("ID")) : child;
    const item = element("li", child.getAttribute("name") ?? child.tagName);
    const below = child.tagName === "SubTree" ? inner.firstElementChild : inner;
    if (below?.children.length) item.append(nested(below, trees));
    made.append(item);
  }
  return made;
}

// --- targets: the numbers as the plant file has them

function targets(cell) {
  const found = draft.state.values.cells?.[cell]?.targets ?? {};
  const made = element("div");
  for (const [target, robots] of Object.entries(found))
    for (const [robot, pose] of Object.entries(robots ?? {})) made.append(targetRow(cell, target, robot, pose));
  if (Object.keys(found).length) made.append(newTarget(cell, found));
  return made;
}

function targetRow(cell, target, robot, pose) {
  const made = element("div", "", { class: "make-target", role: "group", "aria-label": `${target} ${robot}` });
  made.append(element("strong", target), element("span", robot, { class: "make-sort" }));
  const at = ["cells", cell, "targets", target, robot];
  if (typeof pose === "object" && pose !== null)
    for (const [key, value] of Object.entries(pose)) {
      const several = Array.isArray(value);
      (several ? value : [value]).forEach((each, n) => typeof each === "number" && made.append(number(key, each, several ? n : null, at)));
    }
  if (typeof pose?.mm === "number" && pose[APPROACH] === undefined && target !== "home") made.append(number(APPROACH, "", null, at));
  const remove = element("button", "×", { type: "button", class: "tool", "aria-label": `${words.make_remove}: ${target}` });
  remove.dataset.removePlace = JSON.stringify(at.slice(0, 4));
  if (target !== "home") made.append(remove);
  return made;
}

function number(key, value, n, at) {
  const label = element("label", n === null ? key : `${key} ${n + 1}`);
  const input = element("input", "", { type: "number", step: "any" });
  input.value = value;
  input.dataset.place = JSON.stringify([...at, key, ...(n === null ? [] : [n])]);
  label.append(input);
  return label;
}

function set(input) {
  const value = input.valueAsNumber;
  if (Number.isFinite(value)) step("set", { place: JSON.parse(input.dataset.place), value });
}

// A target is new as a copy of another one, whose numbers are then changed.
function newTarget(cell, found) {
  const made = element("div", "", { class: "make-form" });
  const name = element("label", words.make_new_target);
  name.append(element("input", "", { type: "text", maxlength: "40", class: "make-target-name" }));
  const like = element("label", words.make_like);
  const select = element("select", "", { class: "make-target-like" });
  options(select, Object.keys(found).map((each) => [each]));
  like.append(select);
  const button = element("button", words.make_add, { type: "button", class: "act", "aria-label": `${words.make_add}: ${words.make_new_target}` });
  button.dataset.newTarget = cell;
  const teach = element("a", words.make_teach, { class: "act make-teach", href: `?${new URLSearchParams({ tab: "teach", cell })}` });
  made.append(name, like, button, teach);
  return made;
}

async function add(button, cell) {
  const form = button.closest(".make-form");
  const [name, like] = [form.querySelector(".make-target-name").value.trim(), form.querySelector(".make-target-like").value];
  const found = draft.state.values.cells[cell].targets;
  if (!NAME.test(name) || found[name]) return say(found[name] ? fill(words.make_known, { name }) : words.make_name_first);
  if (await step("set", { place: ["cells", cell, "targets", name], value: found[like] })) read();
}
