// What every page of ours does: parts, cells, filters, language, look, the browser's tab.

import * as busy from "./busy.js";
import { drawList, keepingFocus, onChange, setRowFilter, value } from "./live.js";
import * as place from "./place.js";

export const all = (selector) => [...document.querySelectorAll(selector)];
export const words = window.arboledaPage.words;
export const parts = () => all("[data-part]").map((part) => part.dataset.part);
const MOVED = { twin: "cells", panel: "cells", log: "events" }; // addresses of before
export const cells = () => all("[data-choose]").map((card) => card.dataset.choose);
const SCROLLED_PX = 8;
const filters = {};
const hearers = [];

export const onAnswer = (listener) => hearers.push(listener);

export function start() {
  busy.start();
  document.documentElement.lang = window.arboledaPage.language;
  look(lookNow());
  new ResizeObserver(measure).observe(document.querySelector(".top"));
  window.addEventListener("scroll", () => document.documentElement.toggleAttribute("data-scrolled", scrollY > SCROLLED_PX), { passive: true });
  setRowFilter((list, row) => !filters[list] || row?.cell === filters[list]);
  document.addEventListener("click", clicked);
  onChange(inOrder);
  document.querySelector(".cells")?.addEventListener("pointerleave", inOrder);
}

// How high the header is, which nothing else may cover. Of one that is fixed the whole height stays kept free, also
// where a part of it goes away.
function measure([{ target: top }]) {
  const { dataset, style } = document.documentElement;
  if ("scrolled" in dataset && getComputedStyle(top).position === "fixed") return;
  style.setProperty("--top", `${Math.ceil(top.getBoundingClientRect().height)}px`);
}

let isOfPart = false; // whether the answer goes away when its part of the page is left

// A line below the header; `good` is false where the sentence is one of trouble, null where that is not known.
// An answer about a stop `stays`, wherever one goes.
export function answer(sentence, good, stays = false) {
  isOfPart = !stays;
  const line = document.getElementById("answer");
  line.textContent = sentence;
  line.dataset.s = good === null ? "open" : good ? "good" : "bad";
  for (const listener of hearers) listener(good);
  return false;
}

// Whether somebody is at a place that this page has, in its language; else they are led to the nearest one.
export function settled({ tab, cell, task, lang }) {
  if (task && tab !== "tasks") return place.settle({ tab: "tasks" });
  if (MOVED[tab]) return place.settle({ tab: MOVED[tab] });
  if (!parts().includes(tab)) return place.settle({ tab: parts()[0] });
  if (cell && !cells().includes(cell)) return answer(words.no_cell.replace("{cell}", cell), false), place.settle({ cell: null });
  if (lang !== window.arboledaPage.language) return place.settle({ lang: window.arboledaPage.language });
  return true;
}

let part = null;

export function showPart(chosen) {
  const leaves = part !== null && part !== chosen;
  if (leaves && isOfPart) answer("", true);
  part = chosen;
  all("[data-part]").forEach((part) => (part.hidden = part.dataset.part !== chosen));
  all("[data-parts]").forEach((tab) => (tab.dataset.parts.split(" ").includes(chosen) ? tab.setAttribute("aria-current", "page") : tab.removeAttribute("aria-current")));
  all("[data-within]").forEach((ways) => (ways.hidden = !ways.dataset.within.split(" ").includes(chosen)));
  if (leaves) scrollTo(0, 0);
}

// In a crowd a card is opened by who names it, so that all of them are seen at first.
const inCrowd = () => document.querySelector(".cells.crowd") !== null;

let there = null; // the cell that somebody named; else the top one is looked at

export function showCell(named) {
  there = named;
  const chosen = named ?? cells()[0];
  const pressed = inCrowd() ? named : chosen;
  all("article[data-cell]").forEach((cell) => cell.classList.toggle("chosen", cell.dataset.cell === chosen));
  all(".crowd > .cell").forEach((cell) => cell.classList.toggle("opened", cell.dataset.cell === named));
  all("[data-choose]").forEach((card) => card.setAttribute("aria-pressed", card.dataset.choose === pressed));
  window.arboledaTwin?.visit(pressed ?? null);
}

// Trouble first; nothing moves under a pointer that is about to press something.
export function inOrder() {
  const box = document.querySelector(".cells");
  const order = value("order/cells");
  if (!box || !order || box.matches(":hover")) return;
  if (order.every((name, n) => box.children[n]?.dataset.cell === name)) return;
  const found = new Map([...box.children].map((cell) => [cell.dataset.cell, cell]));
  keepingFocus(() => box.append(...order.map((name) => found.get(name))));
  if (!there) showCell(null);
}

const ICONS = { trouble: "tree_trouble", waits: "tree_waits" };

// The tab of the browser, its icon and the header show trouble and who is waited for, also to whom another tab is open.
export function alarm() {
  const [title, state] = value("text/title") ?? ["Arboleda", "well"];
  if (document.title !== title) document.title = title;
  if (document.documentElement.dataset.stands === state) return;
  document.documentElement.dataset.stands = state;
  const icon = document.querySelector("link[rel~=icon]");
  const home = document.querySelector("link[href$='/page.css']").href.replace("page.css", "");
  if (icon) icon.href = `${home}${ICONS[state] ?? "tree"}.svg`;
}

function filterBy(list, cell) {
  filters[list] = cell;
  all(`[data-filter="${list}"]`).forEach((each) => each.setAttribute("aria-pressed", each.dataset.value === cell));
  drawList(list);
}

function cookie(name, what) {
  document.cookie = `arboleda_${name}=${what}; path=/; max-age=31536000; SameSite=Strict`;
}

const LOOKS = ["auto", "light", "dark"];
const lookNow = () => document.cookie.match(/arboleda_look=(\w+)/)?.[1] ?? "auto";

function look(how) {
  document.documentElement.dataset.look = how;
  const button = document.querySelector(".look");
  button.dataset.look = how;
  button.title = `${words.look}: ${words[`look_${how}`]}`;
}

function nextLook() {
  const next = LOOKS[(LOOKS.indexOf(lookNow()) + 1) % LOOKS.length];
  cookie("look", next);
  look(next);
}

function clicked(event) {
  const button = event.target.closest("button");
  if (!button) return;
  const { choose, filter, value: cell, language } = button.dataset;
  const opened = choose && inCrowd() && button.getAttribute("aria-pressed") === "true";
  if (choose) place.go({ cell: opened ? null : choose });
  if (filter) filterBy(filter, cell);
  if (language) cookie("language", language), location.assign(place.address({ lang: language }));
  if (button.classList.contains("look")) nextLook();
}

// Begin once the page is there; `begin` is called once.
export function whenReady(begin) {
  if (document.querySelector(".app") && window.socket) begin();
  else setTimeout(() => whenReady(begin), 20);
}
