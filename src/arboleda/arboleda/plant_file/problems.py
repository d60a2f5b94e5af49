"""Mistakes of one file a person wrote, each with its place in it."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence

from arboleda.model.errors import ConfigError

from .yaml_marks import Mark

Kept = Sequence[object]  # line, column and sentence
PLACED = re.compile(r"(?P<place>[^:\n]+:\d+:\d+: )?(?P<rest>.*)", re.DOTALL)


class Problems:
    """Problems: keeps them until `finish`; `name` is the file's name for people."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._problems: dict[tuple[int, int, str], None] = {}
        self._elsewhere: dict[str, None] = {}

    def keep(self, mark: Mark, sentence: str) -> None:
        self._problems[(mark.line, mark.column, sentence)] = None

    def keep_those_of(self, error: ConfigError) -> None:
        """Keep the problems of another file that this one names; each is kept once."""
        self._elsewhere |= dict.fromkeys(error.problems)

    @property
    def kept(self) -> tuple[list[Kept], list[str]]:
        """The problems of this file, and those of others."""
        return list(self._problems), list(self._elsewhere)

    def keep_all(self, here: Iterable[Kept], elsewhere: Iterable[str]) -> None:
        """Keep the problems that another reading of the same file has `kept`."""
        for line, column, sentence in here:
            self._problems[(int(str(line)), int(str(column)), str(sentence))] = None
        self._elsewhere |= dict.fromkeys(elsewhere)

    def finish(self, cells: Collection[str] = ()) -> None:
        """Raise ConfigError if there is any problem, in the order of the file, those of other files last.

        A problem that is the same in several of these `cells` is told once.
        """
        here = (self._line(*problem) for problem in sorted(self._problems))
        if problems := told_once((*here, *self._elsewhere), cells):
            raise ConfigError(problems)

    def _line(self, line: int, column: int, sentence: str) -> str:
        return f"{self.name}:{line}:{column}: {sentence}"


def told_once(sentences: Iterable[str], cells: Collection[str]) -> tuple[str, ...]:
    """The sentences; of those that differ in their cell alone the first, with the names of all the cells."""
    alike: dict[tuple[str, str], dict[str, str]] = {}  # by what is before and behind the cell: by cell
    for sentence in sentences:
        before, cell, behind = _at_cell(sentence, cells)
        alike.setdefault((before, behind), {}).setdefault(cell, sentence)
    return tuple(_of_cells(list(each), next(iter(each.values()))) for each in alike.values())


def _at_cell(sentence: str, cells: Collection[str]) -> tuple[str, str, str]:
    """The text before the first name of a cell, that name, and the text behind it; the place names none."""
    place, rest = _placed(sentence)
    names = "|".join(re.escape(str(each)) for each in cells)  # whatever the file has in place of a name
    found = re.search(rf"\b({names})\b", rest) if names else None
    if found is None:
        return sentence, "", ""
    return f"{place}{rest[: found.start()]}", found[0], rest[found.end() :]


def _of_cells(cells: Sequence[str], sentence: str) -> str:
    """The sentence, which is about the first of these cells, with the names of all of them before it."""
    place, rest = _placed(sentence)
    return sentence if len(cells) == 1 else f"{place}{', '.join(cells)}: {rest.removeprefix(f'{cells[0]}: ')}"


def _placed(sentence: str) -> tuple[str, str]:
    found = PLACED.fullmatch(sentence)
    return (found["place"] or "", found["rest"]) if found else ("", sentence)
