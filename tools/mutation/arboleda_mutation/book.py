"""Verdicts so far, line by line in a file: a run that was ended goes on where it was."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Verdict of a judge on a mutant.

    `of` is the fingerprint of what it was judged by; `asked` and `ran` are how many seeds, or tests, there
    were and how many it took.
    """

    key: str
    judge: str
    of: str
    killed: bool
    by: str
    ran: int
    asked: int
    cpu_s: float


class Book:
    """Verdicts in a file; those on other sources serve as a hint only."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._rows: dict[tuple[str, str], Verdict] = {}
        for line in path.read_text().splitlines() if path.exists() else ():
            self._keep(Verdict(**json.loads(line)))

    def add(self, verdict: Verdict) -> None:
        self._keep(verdict)
        with self._path.open("a") as file:
            file.write(json.dumps(asdict(verdict)) + "\n")

    def found(self, key: str, judge: str, of: str, asked: int) -> Verdict | None:
        """The verdict on these very sources; one of fewer seeds counts where it is a kill."""
        verdict = self._rows.get((key, judge))
        if verdict is None or verdict.of != of:
            return None
        return verdict if verdict.killed or verdict.asked >= asked else None

    def survived(self, key: str, judge: str, of: str) -> int:
        """Number of seeds that it survived on these very sources."""
        verdict = self._rows.get((key, judge))
        return verdict.asked if verdict and verdict.of == of and not verdict.killed else 0

    def hint(self, key: str, judge: str) -> str:
        """The test or seed that killed it when it was judged last."""
        verdict = self._rows.get((key, judge))
        return verdict.by if verdict and verdict.killed else ""

    def _keep(self, verdict: Verdict) -> None:
        self._rows[verdict.key, verdict.judge] = verdict
