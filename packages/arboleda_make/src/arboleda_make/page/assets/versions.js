// The versions of the plant's files: which is at work, and a way back.

import { inWords } from "./make_state.js";

const { language } = window.arboledaPage;
const EVERY_MS = 10_000;

const part = (id) => document.getElementById(id);
const seen = () => !document.getElementById("part-settings").hidden;

let opened = null; // the version of each cell when this page was opened

export function start() {
  openAnew();
  setInterval(() => seen() && show(), EVERY_MS);
  part("versions").addEventListener("click", back);
  part("versions-restart").querySelector("button").addEventListener("click", restart);
}

// A page from before a cell took another version offers the recipes of before: it is opened anew.
export async function openAnew() {
  const answer = await fetch("/api/versions").catch(() => null);
  if (!answer?.ok) return;
  const now = JSON.stringify((await answer.json()).cells.map(({ cell, version }) => [cell, version]));
  if (now !== (opened ??= now)) location.reload();
}

export async function show() {
  const answer = await fetch(`/versions.json?${new URLSearchParams({ lang: language })}`).catch(() => null);
  if (!answer?.ok) return;
  const found = await answer.json();
  part("versions-box").hidden = false;
  part("versions-now").textContent = found.now;
  part("versions-cells").replaceChildren(...found.cells.map(line));
  offer(found.restart);
  if (JSON.stringify(found.rows) === part("versions").dataset.shown) return; // a button keeps the focus
  part("versions").dataset.shown = JSON.stringify(found.rows);
  part("versions").replaceChildren(...found.rows.map(row));
}

function line(text) {
  const item = document.createElement("li");
  item.textContent = text;
  return item;
}

function row({ number, title, lines, back: label }) {
  const item = line(title);
  if (lines.length) {
    const inner = document.createElement("ul");
    inner.replaceChildren(...lines.map(line));
    item.append(inner);
  }
  if (label) {
    const button = document.createElement("button");
    Object.assign(button, { type: "button", className: "act", textContent: label });
    button.dataset.number = number;
    item.append(button);
  }
  return item;
}

// A restart takes what cells cannot take while the plant runs.
function offer(found) {
  const box = part("versions-restart");
  box.hidden = !found;
  if (!found) return;
  const [said, button] = box.children;
  said.textContent = `${found.said} `;
  button.textContent = found.button;
  button.dataset.wanted = !found.wanted;
}

async function restart({ target }) {
  target.disabled = true;
  const answer = await post("restart", { name: part("versions-box").dataset.by, wanted: target.dataset.wanted === "true" });
  target.disabled = false;
  const said = answer && (await answer.json().catch(() => null));
  part("versions-said").textContent = answer?.ok ? "" : (said?.sentence ?? part("versions-box").dataset.lost);
  show();
}

function post(way, asked) {
  const options = { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(asked) };
  return fetch(`/api/versions/${way}`, options).catch(() => null);
}

async function back(event) {
  const button = event.target.closest("button[data-number]");
  if (!button) return;
  const { by, sure } = part("versions-box").dataset;
  if (!confirm(`${button.textContent}: ${sure}`)) return;
  button.disabled = true;
  const answer = await post(`${button.dataset.number}/put`, { name: by });
  button.disabled = false;
  const said = answer && (await answer.json().catch(() => null));
  part("versions-said").textContent = said ? (answer.ok ? await told(said) : said.sentence) : part("versions-box").dataset.lost;
  show();
}

async function told({ problems, restart }) {
  return (await inWords([...problems, ...restart])).join("\n");
}
