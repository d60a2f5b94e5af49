"""The page's words in one language, and the plant's own sentences in it as far as they are known."""

from __future__ import annotations

import re
from functools import cache
from importlib import resources
from typing import Any

import yaml

from arboleda.core.sentence import Phrase, Sentence

LANGUAGES = ("en", "es")
SLOT = "{}"
NOT_OF_THE_PAGE = ("phrases", "sentences")


class Words:
    """`words("tasks.send")`; `of` for words that the plant chooses, `say` for its sentences."""

    def __init__(self, language: str, tree: dict[str, Any]) -> None:
        self.language = language
        self._phrases = [_Phrase(*pair) for pair in tree["phrases"].items()]
        self._phrases.sort(key=lambda phrase: phrase.weight, reverse=True)
        self._said: dict[str, str] = {}
        self._sentences: dict[str, str] = tree.get("sentences", {})
        self.flat = flat({key: value for key, value in tree.items() if key not in NOT_OF_THE_PAGE})

    def __call__(self, key: str, **values: Any) -> str:
        """The words of a key, with values put in; KeyError where there is no such key."""
        return self.flat[key].format(**values) if values else self.flat[key]

    def of(self, group: str, word: str) -> str:
        """What the plant's `word` is called; the word itself where nobody said."""
        return self.flat.get(f"{group}.{word}", word)

    def say(self, sentence: str | Sentence) -> str:
        """A sentence or a step's name of the plant in this language; as it is where it is not known."""
        if isinstance(sentence, Sentence):
            return sentence.told(self._template, self.say)
        if sentence not in self._said:
            if len(self._said) > 2000:
                self._said.clear()
            self._said[sentence] = self._translated(sentence)
        return self._said[sentence]

    def _template(self, phrase: Phrase) -> str:
        known = phrase.others.get(self.language) or self._sentences.get(phrase.key)
        return phrase.english if known is None else known

    def _translated(self, sentence: str) -> str:
        for phrase in self._phrases:
            found = phrase.slots(sentence)
            if found is not None:
                return phrase.filled([self.say(part) for part in found])
        return sentence


class _Phrase:
    """A sentence with slots in the plant's language, and what it is in another."""

    def __init__(self, plant: str, ours: str) -> None:
        self._pattern = re.compile("(.+)".join(re.escape(part) for part in plant.split(SLOT)), re.DOTALL)
        self._ours = ours
        self.weight = len(plant) - plant.count(SLOT) * len(SLOT)

    def slots(self, sentence: str) -> tuple[str, ...] | None:
        match = self._pattern.fullmatch(sentence)
        return match.groups() if match else None

    def filled(self, parts: list[str]) -> str:
        first, *pieces = self._ours.split(SLOT)
        return first + "".join(part + piece for part, piece in zip(parts, pieces, strict=False))


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
