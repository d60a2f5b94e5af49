"""Mistakes of one file a person wrote, each with its place in it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from arboleda.model.errors import ConfigError

from .yaml_marks import Mark

Kept = Sequence[object]  # line, column and sentence


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

    def finish(self) -> None:
        """Raise ConfigError if there is any problem, in the order of the file, those of other files last."""
        here = (self._line(*problem) for problem in sorted(self._problems))
        if problems := (*here, *self._elsewhere):
            raise ConfigError(problems)

    def _line(self, line: int, column: int, sentence: str) -> str:
        return f"{self.name}:{line}:{column}: {sentence}"
