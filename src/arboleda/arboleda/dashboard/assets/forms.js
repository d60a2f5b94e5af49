// Forms of packages: what was typed goes to the plant, and its outcome is said at the form.

import { outcome } from "./acts.js";

export function start() {
  document.addEventListener("submit", (event) => {
    const form = event.target.closest("[data-takes]");
    if (!form) return;
    event.preventDefault();
    if (!form.hasAttribute("aria-busy")) take(form);
  });
}

async function take(form) {
  const [button, line] = ["[type=submit]", ".outcome"].map((each) => form.querySelector(each));
  const typed = Object.fromEntries(new FormData(form));
  say(line, "", null);
  for (const each of [form, button]) each.setAttribute("aria-busy", "true");
  const { sentence, good } = await outcome(form.dataset.takes, form.dataset.of, typed);
  for (const each of [form, button]) each.removeAttribute("aria-busy");
  say(line, sentence, good);
  if (good) form.reset();
}

function say(line, sentence, good) {
  line.textContent = sentence;
  line.dataset.s = good ? "good" : "bad";
}
