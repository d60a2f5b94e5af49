"""The page's words in one language, and the plant's sentences in it."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from functools import cache, cached_property
from typing import Any

from arboleda.model.cell_states import CellState
from arboleda.model.sentence import Phrase, Sentence
from arboleda.views.verb_words import page_words
from arboleda.web.languages import FIRST, contents
from arboleda.web.languages import LANGUAGES as LANGUAGES  # of pages
from arboleda.web.languages.templates import Templates

PACKML = frozenset(CellState)
ENDS = ("cell_state", "reason", "task_state")  # of a name in two of them the last one says it
REASONS = "reasons"  # of drivers, which are words and no phrases
Text = Phrase | Sentence | str
"""Text of a package: in each language by a phrase, or plain English, which is shown as it is."""
SENTENCES = "sentences"  # the plant's sentences by key; English ones are in its phrases


class Words:
    """Words: `words("tasks.send")` for the page's texts, `of` for the plant's words, `say` its sentences."""

    def __init__(self, language: str, tree: dict[str, Any], english: dict[str, Any]) -> None:
        self.language = language
        self._sentences: dict[str, str] = tree.get(SENTENCES, {})
        self._known: dict[Sentence, str] = {}
        reasons = contents(language, REASONS)
        self._reasons = Templates(reasons, of_devices=reasons)
        self.flat = {**_texts(english), **_texts(tree)}

    def __call__(self, key: str, **values: Any) -> str:
        """The text of a key, with values put in; KeyError if there is no such key."""
        return self.flat[key].format(**values) if values else self.flat[key]

    def also(self, texts: Mapping[str, str]) -> Words:
        """These words, with further texts by their keys."""
        made = copy(self)
        made.flat = {**self.flat, **texts}
        return made

    def asks(self, name: str) -> list[str]:
        """The questions that a person must answer before this verb, one after the other."""
        return [self.flat[key] for key in (f"asks.{name}", f"asks.{name}_again") if key in self.flat]

    def of(self, group: str, word: str) -> str:
        """The page's word for the plant's `word`; the word itself if the language has none."""
        return self.flat.get(f"{group}.{word}", word)

    def cell(self, state: str) -> str:
        """The word for a state of a cell."""
        return self.flat.get(f"cell_plain.{state}") or self.of("cell_state", state)

    def cell_pill(self, state: str) -> list[str]:
        """The live text of a cell's state: word, state, and PackML's name of it where that is another one."""
        word = self.cell(state)
        return [word, state, "" if word == state or state not in PACKML else f"PackML: {state}"]

    @cached_property
    def ends(self) -> dict[str, str]:
        """The words for ends of tasks and their causes within a line, by the plant's own; none in English,
        which says its own."""
        if self.language == FIRST:
            return {}
        found = {
            key.partition(".")[2]: text
            for group in ENDS
            for key, text in self.flat.items()
            if key.startswith(f"{group}.")
        }
        return {
            **{name: f"{text[:1].lower()}{text[1:]}" for name, text in found.items()},
            **contents(self.language, "findings").get("ends", {}),
        }

    def say(self, sentence: Text) -> str:
        """A sentence of the plant in this language; any other text, as of a user's own step, unchanged."""
        if isinstance(sentence, str):
            return sentence
        if isinstance(sentence, Phrase):
            sentence = sentence()
        text = self._known.get(sentence)
        if text is None:
            if len(self._known) > 2000:
                self._known.clear()
            text = self._known[sentence] = sentence.text_by(self._template, self._reasons)
        return text

    def _template(self, phrase: Phrase) -> str:
        """The template of a phrase: of its maker, else from the page's catalogue, else in English."""
        return phrase.others.get(self.language) or self._sentences.get(phrase.key) or phrase.english


def _texts(tree: dict[str, Any]) -> dict[str, str]:
    """The page's own texts in the contents of a language's file."""
    return flat({key: value for key, value in tree.items() if key != SENTENCES})


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, str]:
    """Nested keys as one level, with dots between them."""
    found: dict[str, str] = {}
    for key, value in tree.items():
        name = f"{prefix}{key}"
        found.update(flat(value, f"{name}.") if isinstance(value, dict) else {name: value})
    return found


def tree_of(language: str) -> dict[str, Any]:
    """The contents of a language's file; what it does not say of an operator's verb is in English."""
    tree = contents(language, "page")
    return tree | {group: english | tree.get(group, {}) for group, english in page_words().items()}


@cache
def words(language: str) -> Words:
    """The words of a language; English if it is not one of LANGUAGES."""
    known = language if language in LANGUAGES else FIRST
    return Words(known, tree_of(known), tree_of(FIRST))
