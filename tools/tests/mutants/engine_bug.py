"""Bug of the engine: a mistake that engineers make, as a small edit of one file of the package."""

from __future__ import annotations

import ast
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class EngineBug:
    """A bug: in a file of the package, text that stands there once becomes another one.

    `file` is relative to the package. `argued`: why nobody can notice it, "" for a bug that has to be found.
    """

    file: str
    about: str
    old: str
    new: str
    argued: str = ""

    @property
    def key(self) -> str:
        """Says which bug it is, for the book of verdicts: another change is another bug."""
        return " :: ".join((self.file, self.about, self.old, self.new))

    def edited(self, text: str) -> str:
        """The text of the file with the bug."""
        found = text.count(self.old)
        assert found == 1, f"{self.file} holds this {found} times: {self.old}"
        return text.replace(self.old, self.new)

    def lines(self, text: str) -> tuple[int, int]:
        """The first line of the statement in which the edit begins, and the last line of the edit."""
        begins = text[: text.index(self.old)].count("\n") + 1
        ends = begins + self.old.rstrip("\n").count("\n")
        around = (each for each in ast.walk(ast.parse(text)) if isinstance(each, ast.stmt))
        starts = [each.lineno for each in around if each.lineno <= begins <= (each.end_lineno or 0)]
        return max(starts, default=begins), ends


def bug(file: str, about: str, old: str, new: str, *, argued: str = "") -> EngineBug:
    """A row of a table of bugs."""
    return EngineBug(file=file, about=about, old=old, new=new, argued=argued)
