// A button that is held: said to the plant again and again, until it is let go of. Whoever closes the page, loses the
// network or looks elsewhere holds nothing any more, and the plant halts the robot by itself.

const BEAT_MS = 50;
const MOST_UNDER_WAY = 3;
const UNSEEN_MS = 1500; // after which what was never seen to begin is let go of
const PATIENCE_MS = 2000;

let press = null;
let last = 0;
let hear = () => {};
let whoTeaches = () => null;

export const held = () => press;

// `heard(answer, press, unseen)` gets each answer of the plant, and `{ sentence }` where it refuses; `unseen`: a button
// that is held was let go of because nothing began. `teacher()` is { cell, session }.
export function start(heard, teacher) {
  [hear, whoTeaches] = [heard, teacher];
  window.addEventListener("blur", letGo);
  window.addEventListener("pagehide", letGo);
  document.addEventListener("visibilitychange", () => document.hidden && letGo());
}

// Hold what `body` says: { robot, goal | along | verb, values }. `alone`: it ends by itself, as a step does.
export function hold(body, { alone = false } = {}) {
  letGo();
  const teacher = whoTeaches();
  if (!teacher) return;
  last = Math.max(last + 1, Date.now());
  press = { ...body, number: last, alone, teacher, since: Date.now(), seen: false, underWay: 0 };
  press.timer = setInterval(beat, BEAT_MS, press);
  beat(press);
}

// Go somewhere else with the button that is held.
export function aim(goal) {
  if (press) press.goal = goal;
}

export function letGo() {
  if (!press) return;
  const ended = stopped();
  send({ ...said(ended), held: false }, ended, true);
}

function stopped() {
  const ended = press;
  clearInterval(ended.timer);
  press = null;
  return ended;
}

async function beat(mine) {
  if (mine !== press || mine.underWay >= MOST_UNDER_WAY) return;
  mine.underWay += 1;
  const answer = await send(said(mine), mine);
  mine.underWay -= 1;
  if (mine !== press || !answer) return;
  const moves = answer.teaching?.number === mine.number;
  mine.seen ||= moves;
  const unseen = !mine.seen && Date.now() - mine.since > UNSEEN_MS;
  if (answer.sentence || !answer.teaching || (mine.seen && !moves) || unseen) stopped();
  hear(answer, mine, unseen && !mine.alone); // a step may be over before an answer has it
}

function said({ number, robot, goal, along, verb, values, teacher }) {
  const what = verb ? { verb, values: values ?? {} } : along ? { along } : { goal };
  return { session: teacher.session, number, robot, ...what };
}

async function send(body, { teacher }, keepalive = false) {
  try {
    const asked = { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body), keepalive, signal: AbortSignal.timeout(PATIENCE_MS) };
    return await (await fetch(`/api/teach/${encodeURIComponent(teacher.cell)}/jog`, asked)).json();
  } catch {
    return null; // the plant halts the robot by itself
  }
}

// Make an element a button that is held, by pointer or by key; `body()` says what it holds, `alone()` whether it ends by
// itself: then one press is enough.
export function button(element, body, alone = () => false) {
  const down = (event) => {
    const what = !element.disabled && body();
    if (what) event.preventDefault(), element.focus(), hold(what, { alone: alone() });
  };
  const up = () => press && !press.alone && letGo();
  const isKey = ({ key }) => key === " " || key === "Enter";
  element.addEventListener("pointerdown", (event) => event.button === 0 && down(event));
  for (const over of ["pointerup", "pointercancel", "pointerleave", "blur"]) element.addEventListener(over, up);
  element.addEventListener("keydown", (event) => isKey(event) && (event.repeat ? event.preventDefault() : down(event)));
  element.addEventListener("keyup", (event) => isKey(event) && (event.preventDefault(), up()));
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}
