// What changing a plant adds to the behaviour of its page.

import * as draw from "./draw.js";
import * as make from "./make.js";
import * as teach from "./teach.js";
import * as versions from "./versions.js";

export function start() {
  for (const each of [draw, make, teach, versions]) each.start();
}

export function arrive({ tab, cell }) {
  if (tab === "tasks") versions.openAnew();
  if (tab === "draw") draw.show(cell);
  if (tab === "teach") teach.show(cell);
  else teach.leave();
  make.show(tab === "make");
  make.watch(tab === "draw");
  if (tab === "settings") versions.show();
}
