"""A mutant: one small change of one syntax tree, under a name that outlives moved lines."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """In `function` of `file`, the `nth` place where `old` stands becomes `new`.

    `file` is relative to the package `arboleda`; `function` is "" outside of all functions. `lines` are the
    first and the last line of the statement, `number` counts the changes of the file: it is how this one is
    made again. `removed` and `added` are the changed lines as a person reads them.
    """

    file: str
    function: str
    operator: str
    old: str
    new: str
    nth: int
    number: int
    line: int
    lines: tuple[int, int]
    removed: str
    added: str

    @property
    def key(self) -> str:
        """Says which mutant it is by what stands there, not by where that is."""
        change = f"{_one_line(self.old)} -> {_one_line(self.new)}"
        return f"{self.file}::{self.function or '<module>'}::{self.operator}::{change}::{self.nth}"

    @property
    def place(self) -> str:
        return f"{self.file}:{self.line}"


def _one_line(text: str) -> str:
    return " ".join(text.split())
