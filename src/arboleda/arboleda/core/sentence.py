"""What the plant says, as data: a key with values, of which each language makes its own sentence.

Nobody finds out anything by reading a text; who needs to know looks at the key and at the values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, Union

Value = Union[str, int, float, "Sentence", "tuple[Value, ...]"]


class Phrase:
    """One thing that can be said: its key, and its English with a {slot} for each value.

    `others` has it in further languages, `es="..."`, for a page whose own catalogue does not know the key:
    so a recipe or a kind brings its sentences along.
    """

    __slots__ = ("english", "key", "others")

    def __init__(self, key: str, english: str, **others: str) -> None:
        self.key = key
        self.english = english
        self.others = others

    def __call__(self, **values: Value) -> Sentence:
        return Sentence(self, values)

    def __repr__(self) -> str:
        return f"Phrase({self.key!r}, {self.english!r})"


class Sentence:
    """A phrase with its values: words as they are, numbers, sentences inside it, tuples that make a list.

    `str()` is its English, made when somebody wants it. Equal ones have the same key and values. False is
    only the one that says nothing.
    """

    __slots__ = ("_text", "phrase", "values")

    def __init__(self, phrase: Phrase, values: dict[str, Value]) -> None:
        self.phrase = phrase
        self.values = values
        self._text: str | None = None

    @property
    def key(self) -> str:
        return self.phrase.key

    def told(self, template: Callable[[Phrase], str], word: Callable[[str], str] | None = None) -> str:
        """It in the language whose text for a phrase, with the same slots, is `template`."""
        words = {slot: _told(value, template, word) for slot, value in self.values.items()}
        return template(self.phrase).format(**words)

    def parts(self) -> Iterator[Sentence]:
        """It, and every sentence inside it."""
        yield self
        for value in self.values.values():
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, Sentence):
                    yield from each.parts()

    def __str__(self) -> str:
        if self._text is None:
            self._text = self.told(_english)
        return self._text

    def __repr__(self) -> str:
        return repr(str(self))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sentence):
            return NotImplemented
        return self.key == other.key and self.values == other.values

    def __hash__(self) -> int:
        return hash((self.key, frozenset(self.values.items())))

    def __bool__(self) -> bool:
        return bool(self.phrase.english)


def as_sentence(said: Sentence | str | BaseException) -> Sentence:
    """What somebody said in words of their own as a sentence; an error's where it has one."""
    if isinstance(said, BaseException):
        said = said.args[0] if len(said.args) == 1 and isinstance(said.args[0], Sentence) else str(said)
    return said if isinstance(said, Sentence) else OWN(text=said)


def in_json(value: object) -> str:
    """The `default` with which `json.dumps` writes sentences, as their texts."""
    if isinstance(value, Sentence):
        return str(value)
    raise TypeError(f"{type(value).__name__} is not for JSON")


def _english(phrase: Phrase) -> str:
    return phrase.english


def _told(value: Value, template: Callable[[Phrase], str], word: Callable[[str], str] | None) -> Any:
    if isinstance(value, Sentence):
        return str(value) if template is _english else value.told(template, word)
    if isinstance(value, tuple):
        return ", ".join(str(_told(each, template, word)) for each in value)
    return word(value) if word is not None and isinstance(value, str) else value


OWN = Phrase("own", "{text}")
NOTHING = Phrase("nothing", "")()
BOTH = Phrase("both", "{first}; {second}")
