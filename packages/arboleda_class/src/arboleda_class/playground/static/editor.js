// The editor of a workbook: CodeMirror, with a state for each file and the problems of a file below their lines.

import { basicSetup, Compartment, Decoration, EditorState, EditorView, indentWithTab, keymap, LanguageDescription, languages, StateEffect, StateField, themes, WidgetType } from "./codemirror/index.js";

const look = new Compartment(); // light or dark
const dark = matchMedia("(prefers-color-scheme: dark)");
const tell = StateEffect.define(); // [{line, text}]

class Problem extends WidgetType {
  constructor(text) {
    super();
    this.text = text;
  }
  eq(other) {
    return other.text === this.text;
  }
  toDOM() {
    return Object.assign(document.createElement("div"), { className: "book-problem", textContent: this.text });
  }
}

const problems = StateField.define({
  create: () => Decoration.none,
  update(shown, transaction) {
    for (const effect of transaction.effects) if (effect.is(tell)) return below(transaction.state.doc, effect.value);
    return shown.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

function below(text, found) {
  const rows = found.map(({ line, text: why }) => ({ at: text.line(Math.min(Math.max(line, 1), text.lines)).to, why })).sort((a, b) => a.at - b.at);
  return Decoration.set(rows.map(({ at, why }) => Decoration.widget({ widget: new Problem(why), block: true, side: 1 }).range(at)));
}

// `changed(name, text)` hears of what is written; `label(name)` says which file it is to those who do not see it.
export function editor(parent, { changed, label }) {
  const view = new EditorView({ parent });
  view.scrollDOM.tabIndex = 0; // so that keys alone scroll a long file
  const states = new Map();
  let shown = null;
  const light = () => view.dispatch({ effects: look.reconfigure(dark.matches ? themes.githubDark : []) });
  dark.addEventListener("change", light);

  async function state(name, text, locked) {
    const found = LanguageDescription.matchFilename(languages, name.replace(/\.urdf$/, ".xml"));
    const support = found ? await found.load() : [];
    return EditorState.create({
      doc: text,
      extensions: [
        basicSetup,
        keymap.of([indentWithTab]),
        support,
        look.of([]),
        EditorView.contentAttributes.of({ "aria-label": label(name), spellcheck: "false" }),
        EditorView.updateListener.of((update) => update.docChanged && changed(name, update.state.doc.toString())),
        EditorState.readOnly.of(locked),
        problems,
      ],
    });
  }

  return {
    view,
    async show(name, text, locked) {
      if (shown !== null) states.set(shown, view.state);
      if (!states.has(name)) states.set(name, await state(name, text, locked));
      shown = name;
      view.setState(states.get(name));
      light();
    },
    forget() {
      states.clear();
      shown = null;
    },
    tell: (found) => view.dispatch({ effects: tell.of(found) }),
    go(line) {
      const at = view.state.doc.line(Math.min(Math.max(line, 1), view.state.doc.lines)).from;
      view.dispatch({ selection: { anchor: at }, effects: EditorView.scrollIntoView(at, { y: "center" }) });
    },
    write: (text) => view.dispatch({ changes: { from: 0, to: view.state.doc.length, insert: text } }),
    focus: () => view.focus(),
  };
}
