// For scripts of packages: `import { send, value, changed } from "../arboleda.js"`. What is here goes on; all else may change.

import { outcome } from "./acts.js";
import { onChange, value as known } from "./live.js";
import { answer, words } from "./shell.js";

// Ask for an act of a package, "orders.add", after its question. The outcome is shown, and returned: {sentence, good}.
export async function send(act, of = "", more = {}) {
  const told = await outcome(act, of, more);
  if (told.sentence) answer(told.sentence, told.good);
  return told;
}

// What the part of a package shows now by this key, "orders/open"; undefined before it has shown anything.
export const value = (key) => known(`shown/${key}`);

// Have `callback` called with the value of a key: now, if there is one, and whenever it is another one. It is called
// no more once it breaks.
export function changed(key, callback) {
  let works = true;
  const tell = () => {
    try {
      callback(value(key));
    } catch (error) {
      works = false;
      console.error(error);
      answer(words.script_broke.replace("{package}", key.split("/")[0]).replace("{why}", error.message), false, true);
    }
  };
  onChange((patch) => works && `shown/${key}` in patch && tell());
  if (value(key) !== undefined) tell();
}
