"""Seeds of a campaign as rows of a database, which workers on any host take one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, kw_only=True)
class SeedRow:
    """Result of one seed; `digest` is None until it is done, `broken` names the invariant that failed."""

    seed: int
    digest: str | None
    broken: str | None = None
    cycles: int | None = None
    worker: str | None = None


class Seeds(Protocol):
    """Rows of one campaign; raises StartError for trouble with the database."""

    def lay_out(self, first: int, count: int) -> None:
        """Make a row for each seed; those that are there stay as they are."""

    def do_next(self, run: Callable[[int], SeedRow]) -> SeedRow | None:
        """Do a seed that nobody does or has done; None where there is none."""

    def rows(self) -> list[SeedRow]:
        """All rows, by their number."""

    def close(self) -> None: ...
