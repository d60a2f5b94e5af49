// Where on the page somebody is, as its address says it: part, cell, task, language, and the moment of which record.
// Links and the browser's back lead there.

const KEYS = ["plant", "tab", "cell", "task", "lang", "at", "record"]; // which plant: where one page has several
let arrived = () => {};

export function start(arrive) {
  arrived = () => {
    for (const link of document.querySelectorAll("a[data-go]")) link.href = address(JSON.parse(link.dataset.go));
    arrive(here());
  };
  window.addEventListener("popstate", () => arrived());
  document.addEventListener("click", followed);
}

export function here() {
  const asked = new URLSearchParams(location.search);
  return Object.fromEntries(KEYS.map((key) => [key, asked.get(key) || null]));
}

// The address of another place: what is not named stays as it is here, null leaves it out.
export function address(changes) {
  const there = { ...here(), ...changes };
  return `${location.pathname}?${new URLSearchParams(KEYS.filter((key) => there[key] !== null).map((key) => [key, there[key]]))}`;
}

export function go(changes) {
  const to = address(changes);
  if (to !== location.pathname + location.search) history.pushState(null, "", to);
  arrived();
}

// Have the address say where this is now, for whom it is sent to; nobody arrives anywhere.
export function note(changes) {
  history.replaceState(null, "", address(changes));
}

// Say where this is more exactly, without a step that "back" would undo.
export function settle(changes) {
  history.replaceState(null, "", address(changes));
  arrived();
}

// What a browser does with another button or key held (a new tab, say) stays the browser's.
function followed(event) {
  const link = event.target.closest?.("a[data-go]");
  if (!link || event.button || event.ctrlKey || event.metaKey || event.shiftKey || event.altKey) return;
  const to = JSON.parse(link.dataset.go);
  if (isRecord({ ...here(), ...to }) !== isRecord(here())) return; // another page: the browser opens it
  event.preventDefault();
  go(to);
}

const isRecord = ({ at }) => at !== null;
