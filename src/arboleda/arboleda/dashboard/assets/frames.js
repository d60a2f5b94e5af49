// Frames from the server: put on the page, acknowledged, and missed where none come any more.

import { apply } from "./live.js";

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
  document.documentElement.classList.toggle("silent", silent);
  line.hidden = heardAt > 0 && !silent;
  if (heardAt > 0 && silent) line.textContent = line.dataset.lost.replace("{time}", `${Math.round((Date.now() - heardAt) / 1000)} s`);
}
