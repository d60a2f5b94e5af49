"""Problems of one file that a person wrote, each with its line and column."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence

from arboleda.model.errors import ConfigError

from .yaml_marks import Mark

MarkedProblem = Sequence[object]  # line, column and sentence
PLACED = re.compile(r"(?P<place>[^:\n]+:\d+:\d+: )?(?P<rest>.*)", re.DOTALL)


class Problems:
    """Keeps the problems of a file until `finish`; `name` is the file's name for people."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._problems: dict[tuple[int, int, str], None] = {}
        self._elsewhere: dict[str, None] = {}

    def keep(self, mark: Mark, sentence: str) -> None:
        self._problems[(mark.line, mark.column, sentence)] = None

    def keep_those_of(self, error: ConfigError) -> None:
        """Keep the problems of another file that this file names, each once."""
        self._elsewhere |= dict.fromkeys(error.problems)

    @property
    def problems(self) -> tuple[list[MarkedProblem], list[str]]:
        """The problems of this file, and those of others."""
        return list(self._problems), list(self._elsewhere)

    def keep_all(self, here: Iterable[MarkedProblem], elsewhere: Iterable[str]) -> None:
        """Keep the `problems` of another reading of this file."""
        for line, column, sentence in here:
            self._problems[(int(str(line)), int(str(column)), str(sentence))] = None
        self._elsewhere |= dict.fromkeys(elsewhere)

    def finish(self, cells: Collection[str] = ()) -> None:
        """Raise ConfigError if there is any problem: in the order of this file, then those of other files.

        A problem that several of these `cells` share is told once.
        """
        here = (self._line(*problem) for problem in sorted(self._problems))
        if problems := told_once((*here, *self._elsewhere), cells):
            raise ConfigError(problems)

    def _line(self, line: int, column: int, sentence: str) -> str:
        return f"{self.name}:{line}:{column}: {sentence}"


def told_once(sentences: Iterable[str], cells: Collection[str]) -> tuple[str, ...]:
    """The sentences. Of sentences that differ in their cell alone, the first, with the names of all cells."""
    return tuple(map(_of_cells, _alike(sentences, {cell: {} for cell in cells})))


def counted(sentences: Iterable[str], roles: Mapping[str, Mapping[str, str]]) -> tuple[str, ...]:
    """The sentences. Those that differ in their cell alone, and in devices of one role, are told once.

    `roles` are those of the devices of each cell, by name. The first sentence says how many there are.
    """
    return tuple(
        f"{_of_cells(each)} ({len(each)} times)" if len(each) > 1 else _of_cells(each)
        for each in _alike(sentences, roles)
    )


def _alike(sentences: Iterable[str], roles: Mapping[str, Mapping[str, str]]) -> Iterable[Mapping[str, str]]:
    """The sentences by cell, those together that are alike once each device has the name of its role."""
    alike: dict[tuple[str, str], dict[str, str]] = {}  # by the text around the cell's name
    for sentence in sentences:
        before, cell, behind = _at_cell(sentence, roles)
        alike.setdefault((before, _in_roles(behind, roles.get(cell, {}))), {}).setdefault(cell, sentence)
    return alike.values()


def _in_roles(text: str, roles: Mapping[str, str]) -> str:
    """The text with the role of each device in place of its name."""
    names = "|".join(map(re.escape, roles))
    return re.sub(rf"\b({names})\b", lambda match: f"{{{roles[match[0]]}}}", text) if names else text


def _at_cell(sentence: str, cells: Collection[str]) -> tuple[str, str, str]:
    """The text before the first name of a cell, that name, and the text behind it.

    A name in the sentence's place, such as that of the file, does not count.
    """
    place, text = _placed(sentence)
    names = "|".join(re.escape(str(each)) for each in cells)  # whatever the file has in place of a name
    match = re.search(rf"\b({names})\b", text) if names else None
    if match is None:
        return sentence, "", ""
    return f"{place}{text[: match.start()]}", match[0], text[match.end() :]


def _of_cells(by_cell: Mapping[str, str]) -> str:
    """The sentence of the first of these cells, with the names of all cells before it."""
    cells, sentence = list(by_cell), next(iter(by_cell.values()))
    place, text = _placed(sentence)
    return sentence if len(cells) == 1 else f"{place}{', '.join(cells)}: {text.removeprefix(f'{cells[0]}: ')}"


def _placed(sentence: str) -> tuple[str, str]:
    match = PLACED.fullmatch(sentence)
    return (match["place"] or "", match["rest"]) if match else ("", sentence)
