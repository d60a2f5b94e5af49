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

function applyText(name, [text, state]) {
  for (const element of document.querySelectorAll(`[data-live="${CSS.escape(name)}"]`)) {
    if (element.textContent !== text) element.textContent = text;
    element.dataset.s = state;
  }
}

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
  box.parentElement.classList.toggle("is-empty", rows.length === 0);
}

function keepingFocus(change) {
  const focused = document.activeElement;
  change();
  if (focused?.isConnected) focused.focus({ preventScroll: true });
}

function drawRow(list, id, row, columns) {
  const told = known.get(`row/${list}/${id}`) ?? { state: "", texts: [] };
  const print = JSON.stringify(told);
  if (row?.dataset.print === print) return row;
  row ??= document.createElement("div");
  Object.assign(row.dataset, { row: id, print, s: told.state });
  row.className = "row";
  row.setAttribute("role", "row");
  const cells = told.texts.map((text, n) => cell(text, columns[n], n));
  if (told.link) cells[told.link.column].replaceChildren(link(told.texts[told.link.column], told.link.to));
  if (told.acts) cells.push(acts(told.acts));
  keepingFocus(() => row.replaceChildren(...cells));
  return row;
}

function cell(text, label, number) {
  const made = document.createElement("span");
  made.setAttribute("role", "cell");
  made.className = `column-${number}`;
  if (label) made.dataset.label = label;
  made.textContent = text;
  return made;
}

function link(text, to) {
  const made = document.createElement("a");
  made.dataset.go = JSON.stringify(to);
  made.href = address(to);
  made.textContent = text;
  return made;
}

function acts(offers) {
  const made = document.createElement("span");
  made.setAttribute("role", "cell");
  made.className = "acts";
  made.append(...offers.map(offerButton));
  return made;
}

function offerButton({ act, of, label, does, asks, by_hand: byHand, refused }) {
  const button = document.createElement("button");
  button.type = "button";
  button.className = "act";
  button.textContent = label;
  button.title = does;
  Object.assign(button.dataset, { act, of });
  if (asks) button.dataset.asks = JSON.stringify(asks);
  if (byHand) button.dataset.byHand = "true";
  button.disabled = refused === true;
  return button;
}
