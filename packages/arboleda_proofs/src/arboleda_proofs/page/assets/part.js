// What the proofs add to the behaviour of a plant's page.

import * as demo from "./demo.js";
import * as faults from "./faults.js";

export function start() {
  demo.start();
  faults.start();
}
