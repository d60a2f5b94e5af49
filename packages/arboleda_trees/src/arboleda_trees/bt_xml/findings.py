"""Findings in files of trees: all of them at once, each with its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from arboleda.recipes.of_files import Mark, Place

MOST_LINES = 10  # of warnings of one kind that are named
MOST = 200  # mistakes that are shown


class XmlFault(Exception):
    """Error: the bytes cannot be read further."""

    def __init__(self, mark: Mark, sentence: str) -> None:
        super().__init__(sentence)
        self.mark = mark
        self.sentence = sentence


@dataclass(frozen=True, kw_only=True)
class TreeFinding:
    """Mistake or warning with its place."""

    place: Place
    sentence: str
    is_mistake: bool


@dataclass
class Findings:
    """Mistakes, with which no tree can be used, and warnings. Each is kept once.

    Warnings of one `kind` are told together; without a kind, warnings of one sentence are.
    """

    _mistakes: dict[tuple[Place, str], None] = field(default_factory=dict)
    _warnings: dict[tuple[Place, str], str] = field(default_factory=dict)

    def mistake(self, place: Place, sentence: str) -> None:
        self._mistakes[(place, sentence)] = None

    def warning(self, place: Place, sentence: str, kind: str = "") -> None:
        self._warnings[(place, sentence)] = kind or sentence

    @property
    def entries(self) -> Iterator[TreeFinding]:
        """All findings, in the order of the files; mistakes first."""
        for rows, is_mistake in ((self._mistakes, True), (self._warnings, False)):
            for place, sentence in sorted(rows):
                yield TreeFinding(place=place, sentence=sentence, is_mistake=is_mistake)

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The mistakes as lines, in the order of the files; at most MOST, then how many more there are."""
        lines = [f"{place}: {sentence}" for place, sentence in sorted(self._mistakes)]
        more = len(lines) - MOST
        return tuple(lines) if more <= 0 else (*lines[:MOST], f"and {more} mistakes more")

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings as lines, in the order of the files; warnings of one kind in a file are one line."""
        alike: dict[tuple[str, str], list[tuple[Place, str]]] = {}
        for place, sentence in sorted(self._warnings):
            alike.setdefault((place.file, self._warnings[(place, sentence)]), []).append((place, sentence))
        lines = [
            f"{first}: warning: {sentence}{_more(others)}" for (first, sentence), *others in alike.values()
        ]
        others = len(lines) - MOST
        return tuple(lines) if others <= 0 else (*lines[:MOST], f"and {others} warnings more")


def _more(others: Sequence[tuple[Place, str]]) -> str:
    """The number of further warnings of this kind in the file, and their lines."""
    lines = list(dict.fromkeys(str(place.mark.line) for place, _ in others))
    shown = ", ".join([*lines[:MOST_LINES], *(["..."] if len(lines) > MOST_LINES else [])])
    return f"; {len(others)} more like it: line {shown}" if others else ""
