"""Sentences of the plant as data: a key with values, from which each language makes its own text.

No code reads the text of a sentence: it looks at the key and at the values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Union

FROM_ELSEWHERE = frozenset({"error", "text", "why", "word"})  # slots for words of others, as of a driver
Value = Union[str, int, float, "Sentence", "tuple[Value, ...]"]


class Phrase:
    """Phrase: its key, and its English with a {slot} for each value.

    `others` has the text of further languages, `es="..."`, for pages whose catalogue lacks the key: so a
    recipe or a kind brings its sentences along.
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
    """Phrase with its values: words, numbers, other sentences, and tuples, which make a list.

    `str()` makes its English. Equal sentences have the same key and values. Only an empty sentence is False.
    """

    __slots__ = ("_text", "phrase", "values")

    def __init__(self, phrase: Phrase, values: dict[str, Value]) -> None:
        self.phrase = phrase
        self.values = values
        self._text: str | None = None

    @property
    def key(self) -> str:
        return self.phrase.key

    def text_by(self, template: Callable[[Phrase], str], own: Callable[[str], str] = str) -> str:
        """The text in the language of `template`, which has a text with the same slots for each phrase.

        `own` translates words of others. The parentheses around an empty value are left out.
        """
        words = {
            slot: own(value)
            if slot in FROM_ELSEWHERE and isinstance(value, str)
            else _text_of(value, template, own)
            for slot, value in self.values.items()
        }
        text = template(self.phrase)
        for slot in [slot for slot, word in words.items() if word == ""]:
            text = text.replace(f" ({{{slot}}})", "")
        return text.format(**words)

    def parts(self) -> Iterator[Sentence]:
        """This sentence, and every sentence inside it."""
        yield self
        for value in self.values.values():
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, Sentence):
                    yield from each.parts()

    def data(self) -> dict[str, Any]:
        """Key and values for JSON, with sentences inside it in the same form."""
        return {"key": self.key, "values": {slot: _data(value) for slot, value in self.values.items()}}

    def __str__(self) -> str:
        if self._text is None:
            self._text = self.text_by(_english)
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


def as_sentence(value: Sentence | str | BaseException) -> Sentence:
    """The sentence of an error, or a sentence that has only this text."""
    if isinstance(value, BaseException):
        value = value.args[0] if len(value.args) == 1 and isinstance(value.args[0], Sentence) else str(value)
    return value if isinstance(value, Sentence) else OWN(text=value)


def in_json(value: object) -> str:
    """The `default` with which `json.dumps` writes sentences, as their texts."""
    if isinstance(value, Sentence):
        return str(value)
    raise TypeError(f"{type(value).__name__} is not for JSON")


def from_data(data: Any, phrases: Mapping[str, Phrase]) -> Sentence:
    """The sentence of such data, made of these phrases; ValueError for anything else."""
    try:
        phrase, values = phrases[data["key"]], data["values"].items()
        return phrase(**{slot: _value(value, phrases) for slot, value in values})
    except (AttributeError, KeyError, TypeError) as error:
        raise ValueError(f"{data!r} is no sentence") from error


def retold(english: str, data: Any) -> Sentence:
    """The sentence of another start or version, by its English and its data; ValueError for other data.

    A catalogue that has its key says it in another language.
    """
    literal = english.replace("{", "{{").replace("}", "}}")
    try:
        outer = Phrase(str(data["key"]), literal)
        return outer(**{slot: _retold(value) for slot, value in data["values"].items()})
    except (AttributeError, KeyError, TypeError) as error:
        raise ValueError(f"{data!r} is no sentence") from error


def _retold(data: Any) -> Value:
    if isinstance(data, list):
        return tuple(_retold(each) for each in data)
    return data if isinstance(data, str | int | float) else retold("", data)


def _data(value: Value) -> Any:
    if isinstance(value, tuple):
        return [_data(each) for each in value]
    return value.data() if isinstance(value, Sentence) else value


def _value(data: Any, phrases: Mapping[str, Phrase]) -> Value:
    if isinstance(data, list):
        return tuple(_value(each, phrases) for each in data)
    return data if isinstance(data, str | int | float) else from_data(data, phrases)


def _english(phrase: Phrase) -> str:
    return phrase.english


def _text_of(value: Value, template: Callable[[Phrase], str], own: Callable[[str], str]) -> Any:
    if isinstance(value, Sentence):
        return str(value) if template is _english else value.text_by(template, own)
    if isinstance(value, tuple):
        return ", ".join(str(_text_of(each, template, own)) for each in value)
    return value


OWN = Phrase("own", "{text}")
NOTHING = Phrase("nothing", "")()
BOTH = Phrase("both", "{first}; {second}")


def explained(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with the parts of its `sentence`, `key` and `values`; unchanged if that is text only."""
    sentence = row["sentence"]
    by_key = isinstance(sentence, Sentence) and sentence and sentence.phrase is not OWN
    return {**row, **sentence.data()} if by_key else {**row}
