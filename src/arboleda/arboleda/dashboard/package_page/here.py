"""The spot at which an item of a package stands, and texts there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from arboleda.model.facts import shown
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Sentence

from ..wording import Text, Words

DECIMALS = 3


@dataclass(frozen=True, kw_only=True)
class Here:
    """Spot of an item: of which package, in whose words, at the card of which cell, "" anywhere else.

    `shown` is what the part of the package shows, by its keys.
    """

    package: str
    words: Words
    cell: str = ""
    shown: Mapping[str, Any] = field(default_factory=dict)

    def name(self, key: str) -> str:
        """The name by which elements and values of a key find each other."""
        return ":".join(each for each in (self.package, key, self.cell) if each)

    def given(self, key: str) -> Any:
        """The value of a key, at a card the one of its cell where there is one for each; None if unknown."""
        value = self.shown.get(key)
        return value.get(self.cell) if self.cell and isinstance(value, Mapping) else value

    def say(self, text: Text) -> str:
        return self.words.say(text)

    def text(self, value: object) -> str:
        """The text of a plain value; TypeError for any other."""
        if value is None:
            return ""
        if isinstance(value, Phrase | Sentence | str):
            return self.say(value)
        if isinstance(value, int | float):
            return shown(round(value, DECIMALS) if isinstance(value, float) else value)
        raise TypeError(f"{quoted(value)} is no text and no number")


def shown_by(package: str, links: Mapping[str, Any]) -> dict[str, Any]:
    """The values that parts of a package show, by key; each tells them under the name of its registration."""
    told = (news for name, news in links.items() if name.partition(".")[0] == package)
    return {key: value for news in told if isinstance(news, Mapping) for key, value in news.items()}


def labelled(names: Mapping[str, Text] | Sequence[str]) -> Mapping[str, Text]:
    """Names with their labels; those without any stand for themselves."""
    return names if isinstance(names, Mapping) else {name: name for name in names}
