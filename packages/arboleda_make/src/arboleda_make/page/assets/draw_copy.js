// Recipes in Python copied as trees: into the draft as a new tree of it, or where there is none as a new file.

import { reopened, opened } from "./draw.js";
import { ask, box, say, state } from "./draw_state.js";
import * as make from "./make_state.js";
import { words } from "../shell.js";

const freeName = (recipe, taken) => [`${recipe}_tree`, ...Array.from({ length: 99 }, (_, n) => `${recipe}_tree_${n + 2}`)].find((each) => !taken.includes(each));
let known = []; // the names of all recipes of the cell

export function start() {
  box("python").addEventListener("change", propose);
}

// Offer the recipes of the cell that are no trees.
export async function offer(cell, ofDraft) {
  const cells = ofDraft ? (await ask("/api/make/cells"))?.cells : await ask("/api/recipes");
  const recipes = cells?.find((each) => (each.cell ?? each.name) === cell)?.recipes;
  if (!recipes || state.cell !== cell) return;
  known = recipes.map(({ name }) => name);
  const drawn = recipes.filter(({ sort }) => sort === "drawn").map(({ name }) => name).concat(state.files.map(({ recipe }) => recipe));
  make.options(box("python"), known.filter((each) => !drawn.includes(each)).map((each) => [each]));
  box("python-box").hidden = !box("python").options.length;
  propose();
}

function propose() {
  box("copy").value = box("python").value && freeName(box("python").value, known);
}

// Copy a recipe into the draft, under this name or a free one. Its name, or null where it was refused.
export async function intoDraft(cell, recipe, taken, wanted = "") {
  const name = wanted || freeName(recipe, taken);
  return (await make.step("../make/copy", { cell, recipe, name })) ? name : null;
}

export async function copy(ofDraft) {
  const { cell } = state;
  const [recipe, name] = [box("python").value, box("copy").value.trim()];
  if (!name) return say(words.draw_name_first), box("copy").focus();
  if (ofDraft) {
    if (await intoDraft(cell, recipe, known, name)) await reopened(name), say(make.fill(words.draw_copied, { recipe, name }));
    return;
  }
  const made = await ask("/api/trees/copy", { cell, recipe, name });
  if (made && (await opened({ recipe: name, file: `${name}.xml`, text: made.text }))) say(make.fill(words.draw_copied, { recipe, name }));
}
