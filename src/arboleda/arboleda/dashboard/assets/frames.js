// Frames from the server: put on the page, acknowledged, and missed where none come any more.

import { apply, value } from "./live.js";

const SILENT_MS = 4000;
const ACK_EVERY = 5; // frames
let heardAt = 0;
let count = 0;

export function hear(number, patch) {
  heardAt = Date.now();
  apply(patch);
  if (count++ % ACK_EVERY === 0) window.emitEvent("arboleda", "seen", number);
  watch();
}

export function start() {
  setInterval(watch, 1000);
}

// A page that hears nothing any more must not look as if all were well.
function watch() {
  const silent = Date.now() - heardAt > SILENT_MS;
  const line = document.getElementById("connection");
  const said = line.querySelector("[data-said]") ?? line;
  document.documentElement.classList.toggle("silent", silent);
  line.hidden = heardAt > 0 && !silent;
  if (heardAt > 0 && silent) said.textContent = line.dataset.lost.replace("{time}", `${Math.round((Date.now() - heardAt) / 1000)} s`);
  leadOn(silent);
}

// Who stood by when the last news came may lead the plant by now. A script of this page may not ask another host, and
// the one that is silent may be this browser's: a person goes there. A link stays the same element, else no click meets it.
function leadOn(silent) {
  const box = document.getElementById("standbys");
  const there = JSON.stringify((silent && value("list/standbys")) || []);
  if (!box || box.dataset.there === there) return;
  box.dataset.there = there;
  const links = JSON.parse(there).map(([host, url]) => Object.assign(document.createElement("a"), { textContent: host, href: `${url}/${location.search}` }));
  box.replaceChildren(...links.flatMap((link, number) => [number ? ", " : window.arboledaPage.words.standbys, link]));
}
