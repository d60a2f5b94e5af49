"""Versions of the plant's files."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated


@dataclass(frozen=True, kw_only=True)
class VersionRow:
    """Version of the plant's files that was put to work."""

    number: int
    at: Annotated[str, "In UTC, ISO 8601."]
    by: str
    note: str
    changes: list[str]
    is_at_work: bool


@dataclass(frozen=True, kw_only=True)
class AtWork:
    """Version at work."""

    number: Annotated[int | None, "Null where no version has what is at work."]
    at: str


@dataclass(frozen=True, kw_only=True)
class CellVersion:
    """Version by which a cell works, and which it takes next."""

    cell: str
    version: Annotated[int | None, "Which it took while the plant ran; null: as the plant started."]
    following: Annotated[int | None, "Which it takes next, if any."]
    when: Annotated[str, "now, or when which task has ended."]


@dataclass(frozen=True, kw_only=True)
class Restart:
    """Wish for a restart once all cells rest."""

    by: Annotated[str, "Who wants one once all cells rest; empty: nobody."]
    can: Annotated[bool, "Whether the plant can restart itself here."]


@dataclass(frozen=True, kw_only=True)
class VersionList:
    """Versions of the plant's files, oldest first."""

    at_work: AtWork
    versions: Annotated[list[VersionRow], "Oldest first."]
    cells: list[CellVersion]
    restart: Restart
