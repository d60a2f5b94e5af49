"""The page's words in one language, and the plant's sentences in it."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import yaml

from arboleda.model.sentence import Phrase, Sentence

LANGUAGES = ("en", "es")
SENTENCES = "sentences"  # of the plant, by key, in every language but English: its phrases have that


class Words:
    """`words("tasks.send")`; `of` for words that the plant chooses, `say` for its sentences."""

    def __init__(self, language: str, tree: dict[str, Any]) -> None:
        self.language = language
        self._sentences: dict[str, str] = tree.get(SENTENCES, {})
        self._said: dict[Sentence, str] = {}
        self.flat = flat({key: value for key, value in tree.items() if key != SENTENCES})

    def __call__(self, key: str, **values: Any) -> str:
        """The words of a key, with values put in; KeyError where there is no such key."""
        return self.flat[key].format(**values) if values else self.flat[key]

    def of(self, group: str, word: str) -> str:
        """What the plant's `word` is called; the word itself where nobody said."""
        return self.flat.get(f"{group}.{word}", word)

    def cell(self, state: str) -> str:
        """The word for a state of a cell, behind plain ones where only PackML knows it."""
        word, plain = self.of("cell_state", state), self.flat.get(f"cell_plain.{state}")
        return word if plain is None else f"{plain} ({word})"

    def say(self, said: Sentence | str) -> str:
        """A sentence of the plant in this language; what is none, as of a user's own step, as it is."""
        if isinstance(said, str):
            return said
        text = self._said.get(said)
        if text is None:
            if len(self._said) > 2000:
                self._said.clear()
            text = self._said[said] = said.told(self._template)
        return text

    def _template(self, phrase: Phrase) -> str:
        """As whoever made the phrase has it, else as our catalogue has it, else in English."""
        return phrase.others.get(self.language) or self._sentences.get(phrase.key) or phrase.english


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, str]:
    """Nested keys with dots between them."""
    found: dict[str, str] = {}
    for key, value in tree.items():
        name = f"{prefix}{key}"
        found.update(flat(value, f"{name}.") if isinstance(value, dict) else {name: value})
    return found


def tree_of(language: str) -> dict[str, Any]:
    """What the file of a language says."""
    file = resources.files(__package__).joinpath("words", f"{language}.yaml")
    return yaml.safe_load(file.read_text(encoding="utf-8"))


@cache
def words(language: str) -> Words:
    """The words of a language, English where it is not one of LANGUAGES."""
    known = language if language in LANGUAGES else LANGUAGES[0]
    return Words(known, tree_of(known))
