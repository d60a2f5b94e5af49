// A button whose request has no answer yet shows that it is at work, once that takes longer than is felt to be at once.

const SLOW_MS = 300;
let pressed = { button: null, at: 0, open: 0 };

export function start() {
  const send = window.fetch;
  document.addEventListener("click", notePress, true);
  window.fetch = (...request) => shown(send(...request), asking());
}

function notePress({ target }) {
  const button = target.closest?.("button");
  if (button && button !== pressed.button) pressed = { button, at: 0, open: 0 };
  pressed.at = performance.now();
}

// The button that a request is of: one that was just pressed, or that waits for another request. What the page asks by itself is of none.
const asking = () => (pressed.open || performance.now() - pressed.at < SLOW_MS ? pressed : null);

async function shown(answer, of) {
  if (!of?.button) return answer;
  of.open++;
  const slow = setTimeout(() => of.button.setAttribute("aria-busy", "true"), SLOW_MS);
  try {
    return await answer;
  } finally {
    clearTimeout(slow);
    setTimeout(() => --of.open || of.button.removeAttribute("aria-busy")); // unless the next request of the same press begins now
  }
}
