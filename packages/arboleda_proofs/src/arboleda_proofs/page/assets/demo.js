// What a visitor of a demonstration reads once, and the button that ends it.

import * as acts from "../acts.js";
import { onChange, value } from "../live.js";

const SEEN = "arboleda_demo_seen";

export function start() {
  const box = document.getElementById("demo");
  if (!box) return;
  const isNew = !document.cookie.includes(`${SEEN}=`);
  showLines(isNew);
  document.getElementById("demo-seen").addEventListener("click", () => {
    document.cookie = `${SEEN}=1; path=/; max-age=31536000; SameSite=Strict`;
    showLines(false);
  });
  document.getElementById("demo-end").addEventListener("click", () => acts.send("end_demo", ""));
  const show = () => (box.hidden = value("text/demo")?.[1] === "off");
  show();
  onChange(show);
}

function showLines(shown) {
  for (const id of ["demo-lines", "demo-seen"]) document.getElementById(id).hidden = !shown;
}
