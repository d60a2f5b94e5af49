// Proposals of assistants: what each would change, its tree, what was proved of it, and a person's decision on that very content.

import { tableOf } from "./make_prove.js";
import { ask, box, element, fill, keepName, name, spoken, there } from "./make_state.js";
import * as question from "../question.js";
import { words } from "../shell.js";

const LOOK_MS = 5000;
const PROOF_MS = 1000;
const BUDGET_S = 60;
const says = (sentence) => (box("proposals-note").textContent = sentence ?? "");
const told = (answer) => spoken(answer, "changes");
const isSeen = () => !document.hidden && box("proposals")?.offsetParent;

let rows = [];
let opened = null; // the hash of the proposal whose content is shown

export function start() {
  if (!there()) return;
  box("proposals").addEventListener("click", clicked);
  setInterval(() => isSeen() && look(), LOOK_MS);
}

export async function look() {
  const found = await told(await ask("/api/proposals", undefined, () => {}));
  if (!found) return;
  const count = found.filter(({ stage }) => stage === "open").length;
  document.querySelector('[data-make-panel="proposals"]').dataset.mark = count ? "warning" : "";
  if (JSON.stringify(found) === JSON.stringify(rows)) return; // a button keeps the focus
  rows = found;
  box("proposal-list").replaceChildren(...(rows.length ? rows.map(row) : [element("li", words.make_no_proposal)]));
  if (opened) await open(opened);
}

const short = (hash) => hash.slice(0, 12);

function row({ hash, name: title, by, stage, fits, decided_by, reason, changes }) {
  const made = element("li");
  const state = stage === "open" && !fits ? "outdated" : stage;
  const who = decided_by ? `, ${decided_by}` : "";
  made.append(element("strong", `${title} ${short(hash)}`), element("span", ` ${words[`make_stage_${state}`]}${who}. ${fill(words.make_proposed_by, { by })} `));
  if (reason && stage === "rejected") made.append(element("p", reason));
  if (stage === "open") made.append(element("p", changes.join("; "), { class: "hint" }));
  made.append(button(words.make_look_at, "look", hash));
  return made;
}

function button(text, act, hash, primary = false) {
  const made = element("button", text, { type: "button", class: primary ? "act primary" : "act" });
  Object.assign(made.dataset, { proposal: act, hash });
  return made;
}

const ACTS = { look: open, approve, reject, prove };

function clicked({ target }) {
  const { proposal: act, hash } = target.closest("button")?.dataset ?? {};
  ACTS[act]?.(hash);
}

async function open(hash) {
  const found = await told(await ask(`/api/proposals/${hash}`, undefined, says));
  if (!found) return;
  opened = hash;
  box("proposal").replaceChildren(...shown(found));
  if (found.proof_state.state === "running") setTimeout(() => isSeen() && opened === hash && open(hash), PROOF_MS);
}

// Whatever an assistant wrote is put there as text, and what it draws as a picture that cannot do anything.
function shown({ hash, name: title, by, words: said, changes, warnings, recipes, trees, differing, differences, pictures, proof, proof_state, stage, fits }) {
  const parts = [element("h3", `${title} ${short(hash)}`), element("p", fill(words.make_whole_hash, { hash }), { class: "hint make-hash" })];
  if (said) parts.push(outside(fill(words.make_words_of, { by }), said));
  parts.push(...list(words.make_would_change, changes.length ? changes : [words.make_changes_nothing]));
  for (const [file, lines] of Object.entries(differences)) parts.push(element("pre", lines, { tabindex: "0", role: "region", "aria-label": fill(words.make_difference_of, { file }) }));
  if (recipes.length) parts.push(...list(words.make_asks_for, recipes));
  if (warnings.length) parts.push(...list(words.make_check_says, warnings));
  for (const file of differing) parts.push(...tree(file, trees[file], pictures[file]));
  parts.push(element("h3", words.make_proof_of_it), ...proofs(proof, proof_state));
  if (stage === "open") parts.push(deciding(hash, fits));
  return parts;
}

function outside(title, text) {
  const around = element("figure", "", { class: "make-outside" });
  around.append(element("figcaption", title), element("blockquote", text));
  return around;
}

function list(title, lines) {
  const made = element("ul", "", { class: "make-lines" });
  made.append(...lines.map((text) => element("li", text)));
  return [element("h3", title), made];
}

function tree(file, text, picture) {
  const parts = [element("h3", file)];
  if (picture) {
    const scroll = element("div", "", { class: "make-scroll", tabindex: "0", role: "region", "aria-label": file });
    scroll.append(element("img", "", { src: `data:image/svg+xml,${encodeURIComponent(picture)}`, alt: fill(words.make_picture_of, { file }) }));
    parts.push(scroll);
  }
  const code = element("details");
  code.append(element("summary", words.make_as_text), element("pre", text, { tabindex: "0" }));
  return [...parts, code];
}

function proofs(proof, { state, sentence, doing, done, total }) {
  if (state === "running") return [element("p", fill(words.make_progress, { doing: doing ?? "", done: done ?? 0, total: total ?? "?" }), { role: "status" })];
  if (state === "failed") return [element("p", sentence)];
  if (!proof) return [element("p", words.make_not_proved)];
  const { runs, breaches, unsound, unnoticed, table } = proof;
  const broken = breaches.length + unsound.length;
  const verdict = broken ? words.make_broken : runs.done < runs.of ? words.make_sampled : words.make_held;
  const wrong = unsound.map(({ task, without_faults: { end, cause, broken: why } }) => `${task}: ${why ? why.join(": ") : `${end} ${cause}`}`);
  return [
    element("p", fill(verdict, { done: runs.done, of: runs.of, breaches: broken })),
    ...(wrong.length ? list(words.make_without_faults, wrong) : []),
    ...(unnoticed.length ? list(words.make_nobody_notices, unnoticed.map(({ task, fault, outcome }) => `${task}: ${fault.kind} ${fault.target}: ${outcome.untrue.join("; ")}`)) : []),
    ...table.map(tableOf),
  ];
}

function deciding(hash, fits) {
  const around = element("div", "", { class: "make-form" });
  const label = element("label", words.make_reason);
  label.append(element("input", "", { id: "make-reason", type: "text", maxlength: "1000", autocomplete: "off" }));
  const approving = button(words.make_approve, "approve", hash, true);
  approving.disabled = !fits;
  around.append(button(words.make_prove_it, "prove", hash), approving, label, button(words.make_reject, "reject", hash));
  if (!fits) around.append(element("p", words.make_outdated));
  return around;
}

async function approve(hash) {
  const { changes, recipes } = rows.find((each) => each.hash === hash);
  if (!(await question.confirmed([fill(words.make_sure_approve, { hash: short(hash) }), ...changes, ...recipes].join("\n")))) return;
  says(words.make_checking);
  keepName(box("name").value.trim());
  const done = await spoken(await ask(`/api/proposals/${hash}/approve`, { name: name() }, says));
  if (done) says(done.problems.length ? done.problems.join("\n") : [words.make_approved, ...done.restart].join(" "));
  await look();
}

async function reject(hash) {
  const reason = document.getElementById("make-reason").value.trim();
  if (!reason) return says(words.make_reason_first);
  if (await ask(`/api/proposals/${hash}/reject`, { name: name(), reason }, says)) says("");
  await look();
}

async function prove(hash) {
  if (await ask(`/api/proposals/${hash}/prove`, { recipes: [], budget_s: BUDGET_S }, says)) await open(hash);
}
