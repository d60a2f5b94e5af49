// What a visitor of a demonstration reads once, which goes by itself, and the button that ends the demonstration.

import * as acts from "../acts.js";
import { onChange, value } from "../live.js";

const SEEN = "arboleda_demo_seen";
const SHOWN_MS = 20_000; // time to read it
const at = (id) => document.getElementById(id);
let isNew = !document.cookie.includes(`${SEEN}=`);

export function start() {
  if (!at("demo")) return;
  for (const press of ["click", "keydown"]) document.addEventListener(press, seen, { once: true });
  if (isNew) setTimeout(seen, SHOWN_MS);
  at("demo-end").addEventListener("click", () => acts.send("end_demo", ""));
  show();
  onChange(show);
}

// Somebody has read it, or is at work already.
function seen() {
  isNew = false;
  document.cookie = `${SEEN}=1; path=/; max-age=31536000; SameSite=Strict`;
  show();
}

function show() {
  const isOn = value("text/demo")?.[1] === "on";
  at("demo-on").hidden = !isOn;
  at("demo").hidden = !isOn || !isNew;
}
