// Puts the plant's frames on the page. Whatever comes from the plant is text, never HTML.

import { address } from "./place.js";

const known = new Map(); // key -> value, as in faces/__init__.py
const listeners = [];
let rowFilter = () => true;

export const value = (key) => known.get(key);
export const onChange = (listener) => listeners.push(listener);
export const setRowFilter = (filter) => (rowFilter = filter);

const KINDS = { text: applyText, bar: applyBar, rows: markList, row: markList };
const stale = new Set(); // lists to draw anew after this frame

export function apply(patch) {
  for (const [key, now] of Object.entries(patch)) {
    known.set(key, now);
    const [kind, rest] = split(key);
    KINDS[kind]?.(rest, now);
  }
  for (const list of stale) drawList(list);
  stale.clear();
  for (const listener of listeners) listener(patch);
}

export function split(key) {
  const at = key.indexOf("/");
  return [key.slice(0, at), key.slice(at + 1)];
}

function applyText(name, [text, state, about]) {
  for (const element of document.querySelectorAll(`[data-live="${CSS.escape(name)}"]`)) {
    if (element.textContent !== text) element.textContent = text;
    element.dataset.s = state;
    if (about !== undefined) element.title = about;
    if (element.dataset.ofTask) element.href = ofTask(element.dataset.ofTask, state);
  }
}

const ofTask = (path, task) => `${path}?${new URLSearchParams({ task, lang: window.arboledaPage.language })}`;

function applyBar(name, share) {
  for (const element of document.querySelectorAll(`[data-bar="${CSS.escape(name)}"]`)) {
    element.style.width = `${100 * (share ?? 0)}%`;
    element.parentElement.hidden = share === null;
  }
}

function markList(rest, _) {
  stale.add(known.has(`rows/${rest}`) ? rest : rest.slice(0, rest.indexOf("/")));
}

export function drawList(list) {
  const box = document.querySelector(`[data-rows="${CSS.escape(list)}"]`);
  if (!box) return;
  const before = new Map([...box.children].map((row) => [row.dataset.row, row]));
  const ids = (known.get(`rows/${list}`) ?? []).filter((id) => rowFilter(list, known.get(`row/${list}/${id}`)));
  const rows = ids.map((id) => drawRow(list, id, before.get(id), box.dataset.columns.split("|")));
  if (rows.length !== box.children.length || rows.some((row, n) => box.children[n] !== row))
    keepingFocus(() => box.replaceChildren(...rows));
  box.closest(".table").classList.toggle("is-empty", rows.length === 0);
}

export function keepingFocus(change) {
  const back = wayBack();
  change();
  back();
}

// The way back to what has the focus now. Where that was pressed and has gone, the keyboard is at what is offered now
// in its row or its list, else at its card, or in the header at what opens the menu. Where it takes no press any more,
// the keyboard is at what is offered beside it.
export function wayBack() {
  const focused = document.activeElement;
  const [row, list, around, group] = ["[data-row]", "[data-rows]", "article, .top", "fieldset"].map((each) => focused?.closest(each));
  const offered = () => [row, list, group].map((each) => each?.isConnected && each.querySelector("button:enabled")).find(Boolean);
  return () => {
    const next = focused?.isConnected && !focused.matches(":disabled") ? focused : (list || group) && (offered() || around?.querySelector("[data-choose], [data-menu]"));
    next?.focus({ preventScroll: true });
  };
}

// Only what has changed is drawn anew: a button that somebody is pressing must not go away under the finger.
function drawRow(list, id, row, columns) {
  const told = known.get(`row/${list}/${id}`) ?? { state: "", texts: [] };
  const print = JSON.stringify(told);
  if (row?.dataset.print === print) return row;
  row ??= document.createElement("div");
  row.className = "row";
  Object.assign(row.dataset, { row: id, print, s: told.state });
  const titled = columns.some(Boolean);
  row.setAttribute("role", titled ? "row" : "listitem");
  const cells = told.texts.map((text, n) => ({ text, label: columns[n], name: `column-${n}`, ...(told.link?.column === n ? { to: told.link.to, href: told.link.href } : {}) }));
  if (told.acts) cells.push({ acts: told.acts, name: "acts" });
  cells.forEach((said, n) => {
    const before = row.children[n];
    if (before?.dataset.print === JSON.stringify(said)) return;
    const made = cell(said);
    made.dataset.print = JSON.stringify(said);
    if (titled) made.setAttribute("role", "cell");
    keepingFocus(() => (before ? before.replaceWith(made) : row.append(made)));
  });
  while (row.children.length > cells.length) row.lastChild.remove();
  return row;
}

function cell({ text, label, name, to, href, acts }) {
  const made = document.createElement("span");
  made.className = name;
  if (label) made.dataset.label = label;
  if (acts) made.append(...acts.map(offerButton));
  else made.append(to ? link(text, to) : href ? outside(text, href) : text);
  return made;
}

function link(text, to) {
  const made = document.createElement("a");
  made.dataset.go = JSON.stringify(to);
  made.href = address(to);
  made.textContent = text;
  return made;
}

// The page of somebody else, who does not learn from where one comes.
function outside(text, href) {
  return Object.assign(document.createElement("a"), { href, textContent: text, target: "_blank", rel: "noopener noreferrer" });
}

function offerButton({ act, of, label, does, asks, by_hand: byHand, arguments: told, refused, state, name }) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "act";
  button.textContent = label;
  button.title = does;
  if (act) Object.assign(button.dataset, { act, of });
  if (asks) button.dataset.asks = JSON.stringify(asks);
  if (byHand) button.dataset.byHand = "true";
  if (told) button.dataset.arguments = JSON.stringify(told);
  if (state) button.dataset.s = state;
  if (name) button.setAttribute("aria-label", name);
  button.disabled = refused === true;
  return button;
}
