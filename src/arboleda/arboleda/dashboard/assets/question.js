// A question to the person before something is done. It must never keep anybody from the stop: showModal() would take
// the header's stop away from mouse, touch and keyboard, so the rest of the page is made inert here, and the stop is not.

import { wayBack } from "./live.js";

const words = window.arboledaPage.words;
const setAside = () => document.querySelectorAll("#parts, #node, #menu, .top > :not(.stop, #connection, #answer)");
let dismissOpen = () => {};

// Answer the open question with "no"; what it was about has changed, or somebody has walked away from it.
export const dismiss = () => dismissOpen();

export function start() {
  document.addEventListener("keydown", (event) => event.key === "Escape" && dismiss());
}

export function confirmed(question) {
  dismiss();
  const back = wayBack();
  const dialog = drawn(question);
  const [no, yes] = dialog.querySelectorAll("button");
  setAside().forEach((part) => (part.inert = true));
  document.querySelector(".app").append(dialog);
  dialog.show();
  no.focus();
  return new Promise((resolve) => {
    const close = (answer) => {
      dismissOpen = () => {};
      dialog.remove();
      setAside().forEach((part) => (part.inert = false));
      back();
      resolve(answer);
    };
    dismissOpen = () => close(false);
    no.addEventListener("click", () => close(false));
    yes.addEventListener("click", () => close(true));
  });
}

function drawn(question) {
  const dialog = element("dialog");
  const text = element("p", question);
  text.id = "question";
  dialog.setAttribute("role", "alertdialog");
  dialog.setAttribute("aria-labelledby", text.id);
  const [no, yes] = [element("button", words.no), element("button", words.yes)];
  yes.className = "primary";
  const buttons = element("div");
  buttons.append(no, yes);
  dialog.append(text, buttons);
  return dialog;
}

function element(name, text = "") {
  const made = document.createElement(name);
  made.textContent = text;
  return made;
}
