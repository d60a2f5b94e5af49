// A workbook: the text of a lesson, exercise or plant, its files in an editor, and what comes of them.

import { editor } from "./editor.js";
import { begin } from "./python.js";

const KINDS = ["lesson", "exercise", "plant"];
const SLOW_MS = 1000; // then what is being done can be interrupted
const at = (id) => document.getElementById(id);
const made = (tag, text = "", className = "") => Object.assign(document.createElement(tag), { textContent: text, className });
const asked = new URLSearchParams(location.search);
const json = async (file) => (await fetch(`./books/${file}.json`)).json();

const { books, words } = await json("index");
const cookie = document.cookie.match(/arboleda_language=(\w+)/)?.[1];
const language = [asked.get("lang"), cookie, ...navigator.languages].map((each) => each?.slice(0, 2)).find((each) => words[each]) ?? "en";
const say = (word, more = {}) => Object.entries(more).reduce((text, [key, value]) => text.replace(`{${key}}`, value), words[language][word]);
const kind = KINDS.find((each) => asked.has(each)) ?? KINDS[0];
const chosen = books.find((each) => each.kind === kind && each.name === (asked.get(kind) ?? books[0].name));

let python = null;
let book, edit;
let files = {}; // the texts of all files, as they are written now
let built = null; // the files of the plant that is shown
let shown = ""; // the name of the file in the editor
let troubles = []; // {file, line, text}
let hints = 0;
let pending = 0;
window.arboledaPython = { ask: (what, request) => ask(what, request) };

// What is wider than its box is scrolled by keys, too.
const wide = new ResizeObserver((seen) => {
  for (const { target } of seen) target.scrollWidth > target.clientWidth ? (target.tabIndex = 0) : target.removeAttribute("tabindex");
});

function page() {
  document.documentElement.lang = language;
  for (const each of document.querySelectorAll("[data-word]")) each.textContent = say(each.dataset.word);
  for (const each of document.querySelectorAll("[data-label]")) each.setAttribute("aria-label", say(each.dataset.label));
  at("book-frame").title = say("shown");
  for (const each of KINDS) {
    const group = at("book-choice").appendChild(Object.assign(document.createElement("optgroup"), { label: say(each) }));
    for (const { kind: of, name, title } of books) if (of === each) group.append(new Option(title[language], `${of}=${name}`, false, of === chosen?.kind && name === chosen?.name));
  }
  if (!chosen) at("book-choice").selectedIndex = -1;
  at("book-choice").onchange = () => location.assign(`?${at("book-choice").value}&lang=${language}`);
  const other = Object.keys(words).find((each) => each !== language);
  Object.assign(at("book-language"), { textContent: say("other_language"), lang: other, href: `?${kind}=${chosen?.name ?? asked.get(kind)}&lang=${other}`, onclick: speak });
  at("book-playground").href = `./index.html?lang=${language}`;
  document.addEventListener("click", ({ target }) => {
    const { does, show, file, line } = target.closest("button")?.dataset ?? {};
    if (does) DOES[does]();
    if (show) part(show);
    if (file) turn(file, Number(line)).then(() => Number(line) && edit.focus());
  });
  part("text");
}

// In another language the same run goes on, where the plant is that of what is written.
async function speak(event) {
  const { arboledaPlay } = at("book-frame").contentWindow;
  if (!arboledaPlay || JSON.stringify(built) !== JSON.stringify(files)) return;
  event.preventDefault();
  await Promise.race([arboledaPlay.leave().catch(() => {}), new Promise((done) => setTimeout(done, SLOW_MS))]);
  location.assign(event.target.href);
}

function part(name) {
  document.querySelector(".book").dataset.shown = name;
  for (const each of document.querySelectorAll("[data-show]")) each.setAttribute("aria-pressed", each.dataset.show === name);
}

async function open() {
  book = await json(`${chosen.kind}-${chosen.name}`);
  at("book-title").textContent = document.title = book.title[language];
  at("book-text").innerHTML = book.text[language]; // made with the site, of its own pages
  for (const each of at("book-text").querySelectorAll("pre")) wide.observe(each);
  wide.observe(at("book-output"));
  if (book.note) at("book-text").prepend(made("p", say(book.note), "book-note"));
  const kept = keep.read();
  files = { ...book.files, ...kept.files };
  at("book-arguments").value = kept.arguments ?? book.arguments ?? "";
  at("book-typed").value = kept.typed ?? "";
  at("book-student").value = kept.student ?? "";
  for (const each of ["arguments", "typed", "student"]) at(`book-${each}`).oninput = keep.write;
  at("book-load").onchange = load;
  at("book-call").hidden = !book.program || Boolean(book.elsewhere);
  const isExercise = book.kind === "exercise";
  for (const each of ["judge", "hint"]) button(each).hidden = !isExercise;
  at("book-named").hidden = !isExercise;
  button("record").hidden = !book.record;
  if (isExercise) button("run").classList.remove("primary");
  document.querySelector(".book-plant").hidden = document.querySelector("[data-show=plant]").hidden = !book.plant;
  edit = editor(at("book-editor"), { changed, label: (file) => say("editor", { file }) });
  await turn(book.yours[0]);
  if (book.elsewhere) {
    button("run").disabled = true;
    return report(book.elsewhere, false);
  }
  python = begin(() => {});
  report("loading");
  await attempt(begun);
}

// Wait until Python is there, and the plant of what is written; of what it was, where that is no plant.
async function begun() {
  if (!book.plant) return ask("unpack", { data: "", known: [] }).then(() => say_nothing("loading"));
  if (await build(files, "loading")) return;
  const found = troubles;
  await build(book.files, "loading");
  await wrong(found);
}

const button = (does) => document.querySelector(`[data-does=${does}]`);

function ask(what, request, progress) {
  pending++;
  const slow = setTimeout(() => (button("interrupt").disabled = false), SLOW_MS);
  return python.ask(what, { ...request, language }, progress).finally(() => {
    clearTimeout(slow);
    if (!--pending) button("interrupt").disabled = true;
  });
}

// What is written survives a reload, where the browser lets it.
const keep = {
  place: () => `arboleda/${book.kind}/${book.name}`,
  read() {
    try {
      return JSON.parse(localStorage.getItem(this.place())) ?? {};
    } catch {
      return {};
    }
  },
  write() {
    const own = Object.fromEntries(book.yours.filter((each) => files[each] !== book.files[each]).map((each) => [each, files[each]]));
    const text = { files: own, arguments: at("book-arguments").value, typed: at("book-typed").value, student: at("book-student").value };
    try {
      localStorage.setItem(keep.place(), JSON.stringify(text));
    } catch {
      report("not_kept", false);
    }
  },
};

function changed(name, text) {
  files[name] = text;
  keep.write();
}

// Show a file, at a line of it if there is one.
async function turn(name, line = 0) {
  const locked = !book.yours.includes(name);
  await edit.show(name, files[name], locked);
  at("book-files").replaceChildren(
    ...Object.keys(files).map((each) => {
      const tab = made("button", book.yours.includes(each) ? each : `${each} (${say("of_the_exercise")})`, "tool");
      tab.type = "button";
      tab.dataset.file = each;
      tab.dataset.line = 0;
      tab.setAttribute("aria-pressed", each === name);
      return tab;
    }),
  );
  at("book-note").hidden = !locked;
  at("book-note").textContent = locked ? say("locked", { file: name }) : "";
  shown = name;
  mark();
  if (line) edit.go(line);
}

const mark = () => edit.tell(troubles.filter(({ file, line }) => file === shown && line));

function report(word, good = null, more = {}) {
  const line = made("p", say(word, more), good === null ? "" : good ? "is-good" : "is-bad");
  line.dataset.word = word;
  at("book-said").replaceChildren(line);
}

function say_nothing(word) {
  if (at("book-said").firstChild?.dataset.word === word) at("book-said").replaceChildren();
}

// For tests: the text of the file in the editor, and its name.
window.arboledaWork = { shown: () => shown, write: (text) => edit.write(text), text: () => edit.view.state.doc.toString() };

// Build the plant of these files and show it; the one of before stays where they are none.
async function build(these, meanwhile = "running") {
  report(meanwhile);
  const { problems } = await ask("build", { files: these, plant: book.plant });
  await wrong(problems);
  if (problems.length) return false;
  built = { ...these };
  frame("work");
  report("built", true);
  return true;
}

async function wrong(problems) {
  troubles = problems;
  mark();
  if (!problems.length) return;
  report(book.plant ? "wrong" : "broke", false);
  for (const each of problems) at("book-said").append(sentence(each));
  const first = problems.find(({ file }) => file in files);
  if (first) await turn(first.file, first.line);
}

// A sentence on a file, which leads to its line.
function sentence({ file, line, text }) {
  if (!(file in files)) return made("p", text, "is-bad");
  const row = made("p", "", "is-bad");
  const link = made("button", `${file}, ${say("line", { line })}: ${text}`, "link");
  Object.assign(link.dataset, { file, line });
  row.append(link);
  return row;
}

function frame(plant) {
  const now = new URLSearchParams(at("book-frame").contentWindow.location.search);
  const tab = now.get("tab") ? `&tab=${now.get("tab")}` : "";
  at("book-frame").contentWindow.location.replace(new URL(`./index.html?within=1&plant=${plant}&lang=${language}${tab}`, location.href));
}

const DOES = {
  run: () => attempt(run),
  judge: () => attempt(judge),
  interrupt,
  reset,
  hint() {
    const text = made("div");
    hints = Math.min(hints + 1, book.hints.length);
    text.append(made("strong", `${say("hint")} ${hints}/${book.hints.length}`));
    text.insertAdjacentHTML("beforeend", book.hints[hints - 1][language]); // made with the site
    at("book-hint").replaceChildren(text);
  },
  record: () => attempt(async () => (await ask("record", { exercise: book.name })).film && (frame("story"), part("plant"))),
  play: () => (frame("story"), part("plant")),
  download: () => attempt(download),
  load: () => at("book-load").click(),
};

// Do one thing at a time; what breaks is said.
async function attempt(act) {
  const buttons = [...document.querySelectorAll("[data-does]")].filter((each) => each.dataset.does !== "interrupt" && !each.disabled);
  for (const each of buttons) each.disabled = true;
  try {
    await act();
  } catch (error) {
    if (error.message !== "stopped") at("book-said").replaceChildren(made("p", error.message, "is-bad"));
  } finally {
    for (const each of buttons) each.disabled = false;
    at("book-progress").hidden = true;
  }
}

// The plant of what is written, where there is one and it was changed; then the program, where there is one.
async function run() {
  const isNew = book.plant && (!book.program || JSON.stringify(built) !== JSON.stringify(files));
  if (isNew && !(await build(files))) return;
  if (!book.program) return;
  report("running");
  const request = { files, program: book.program, arguments: at("book-arguments").value, typed: at("book-typed").value };
  const { output, pictures, problem, sentence: refused } = await ask("program", request);
  at("book-said").replaceChildren(...(refused ? [made("p", refused, "is-bad")] : []));
  at("book-output").hidden = false;
  at("book-output").textContent = output ?? "";
  at("book-pictures").replaceChildren(
    ...Object.entries(pictures ?? {}).map(([alt, text]) => Object.assign(new Image(), { alt, src: `data:image/svg+xml,${encodeURIComponent(text)}` })),
  );
  await wrong(problem ? [problem] : []);
}

async function judge() {
  report("judging");
  at("book-progress").hidden = false;
  at("book-progress").value = 0;
  const verdict = await ask("judge", { exercise: book.name, files: own() }, (share) => (at("book-progress").value = share));
  report(verdict.passes ? "passes" : "fails", verdict.passes);
  for (const { says, seen, story } of verdict.findings) {
    const lines = seen.split("\n").map((line) => made("p", `${say("not_so")} ${line}`, "is-bad"));
    at("book-said").append(made("p", `${say("to")} ${says[language] ?? says.en}`), ...lines);
    if (story.length) wide.observe(at("book-said").appendChild(made("pre", story.join("\n"))));
  }
  if (!verdict.film) return;
  const play = made("button", say("play"), "act");
  play.dataset.does = "play";
  at("book-said").append(play);
}

// End Python, whatever it does, and begin again with the plant that was shown.
async function interrupt() {
  python.end();
  python = begin(() => {});
  report("stopped");
  if (built) await build(built, "stopped").catch(() => {});
}

async function reset() {
  if (!confirm(say("reset_sure"))) return;
  files = { ...book.files };
  at("book-arguments").value = book.arguments ?? "";
  at("book-typed").value = "";
  await renewed();
}

async function renewed() {
  keep.write();
  troubles = [];
  at("book-hint").replaceChildren();
  edit.forget();
  await turn(shown);
  if (book.plant) await attempt(() => build(files));
}

const own = () => Object.fromEntries(book.yours.map((each) => [each, files[each]]));

async function download() {
  const student = at("book-student").value.trim();
  if (book.kind === "exercise" && !student) return report("name_first", false);
  const request = { exercise: book.kind === "exercise" ? book.name : "", name: book.name, student, files: own() };
  const { name, data, sentence: refused } = await ask("pack", request);
  if (refused) return at("book-said").replaceChildren(made("p", refused, "is-bad"));
  Object.assign(made("a"), { href: `data:application/zip;base64,${data}`, download: name }).click();
}

async function load() {
  const [file] = at("book-load").files;
  at("book-load").value = "";
  if (file) await attempt(() => take(file));
}

async function take(file) {
  const known = book.yours;
  let found = {};
  if (file.name.endsWith(".zip")) {
    const data = await new Promise((done) => Object.assign(new FileReader(), { onload: ({ target }) => done(target.result.split(",")[1] ?? "") }).readAsDataURL(file));
    const answer = await ask("unpack", { data, known });
    if (answer.sentence) return at("book-said").replaceChildren(made("p", answer.sentence, "is-bad"));
    found = answer.files;
  } else if (known.includes(file.name)) found = { [file.name]: await file.text() };
  else return report("not_loaded", false, { file: file.name, known: known.join(", ") });
  Object.assign(files, found);
  await renewed();
  if (!book.plant) report("loaded", true);
}

page();
if (!chosen) {
  report("nowhere", false);
  document.querySelector(".book").dataset.shown = "code"; // where it says so
} else await open();
