"""Mend: a change of a plant's files as data, with the sentence that people read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from arboleda.model.counting import counted
from arboleda.model.errors import ArboledaError

Texts = Mapping[str, str]


class MendRefused(ArboledaError):
    """The files are others than those that a mend was made for."""


@dataclass(frozen=True, kw_only=True)
class Edit:
    """Edit: `old` in a file becomes `new`; line and column count from 1, columns in characters."""

    file: str
    line: int
    column: int
    old: str
    new: str


@dataclass(frozen=True, kw_only=True)
class Mend:
    """Edits with which a plant was tried.

    `mends` are the sentences of the findings that these edits remove, `left` is how many findings remain.
    """

    sentence: str
    edits: tuple[Edit, ...]
    mends: tuple[str, ...]
    left: int

    @property
    def words(self) -> str:
        """The sentence, and the number of findings that would remain."""
        left = f"; {counted(self.left, 'finding')} would be left" if self.left else ""
        return f"{self.sentence}{left}"

    @property
    def plain(self) -> dict[str, Any]:
        """The mend for JSON."""
        return asdict(self)


@dataclass(frozen=True, kw_only=True)
class Cut:
    """Cut: the characters from `start` to `end` of a file become `new`."""

    file: str
    start: int
    end: int
    new: str


def edit_of(texts: Texts, cut: Cut) -> Edit:
    """A cut as an edit, with its line and column."""
    before = texts[cut.file][: cut.start]
    return Edit(
        file=cut.file,
        line=before.count("\n") + 1,
        column=len(before) - (before.rfind("\n") + 1) + 1,
        old=texts[cut.file][cut.start : cut.end],
        new=cut.new,
    )


def cut_between(file: str, old: str, new: str) -> Cut:
    """The shortest cut that makes one text the other."""
    most = min(len(old), len(new))
    start = next((n for n in range(most) if old[n] != new[n]), most)
    behind = most - start
    same = next((n for n in range(behind) if old[-1 - n] != new[-1 - n]), behind)
    return Cut(file=file, start=start, end=len(old) - same, new=new[start : len(new) - same])


def edited(texts: Texts, edits: Iterable[Edit]) -> dict[str, str]:
    """The texts with these edits, whose lines and columns are those of `texts`.

    MendRefused where a text does not have what an edit replaces.
    """
    changed, rows = dict(texts), [(_start(texts, each), each) for each in edits]
    for start, edit in sorted(rows, key=lambda row: row[0], reverse=True):
        text = changed[edit.file]
        changed[edit.file] = text[:start] + edit.new + text[start + len(edit.old) :]
    return changed


def _start(texts: Texts, edit: Edit) -> int:
    lines = texts.get(edit.file, "").splitlines(keepends=True)
    start = sum(map(len, lines[: edit.line - 1])) + edit.column - 1
    if edit.file not in texts or not texts[edit.file].startswith(edit.old, start):
        raise MendRefused(f"{edit.file}:{edit.line}:{edit.column}: there is no {edit.old!r} any more")
    return start
