"""Kept portions: what was proved already, in a file for each recipe as it was then."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Protocol

from .outcome import outcome_from, plain
from .proof import Proved
from .proof_tally import RecipeKey
from .scenario import Scenario

SUFFIX = ".jsonl"


class Portions(Protocol):
    """Portions of a proof by number: their scenarios, names that tell all that is run, and numbers of runs.

    `number` raises KeyError or ValueError for a name that none has.
    """

    def scenario(self, number: int) -> Scenario: ...
    def name(self, number: int) -> str: ...
    def number(self, name: str) -> int: ...
    def count(self, number: int) -> int: ...


class Kept:
    """Kept: a file of proved portions for each recipe in a folder, under the recipe's digest.

    `digests` has those of all recipes of the plant; what is kept of any other one goes. `trouble` is why
    something could not be kept, read or removed.
    """

    def __init__(self, folder: Path, digests: Mapping[RecipeKey, str], proof: Portions) -> None:
        self._folder = folder
        self._files = {key: folder / f"{digest}{SUFFIX}" for key, digest in digests.items()}
        self.trouble: str | None = None
        self._proof = proof

    def known(self) -> dict[int, Proved]:
        """The portions of this proof that were proved before, by number."""
        return {each.number: each for each in self._read()}

    def keep(self, proved: Proved) -> None:
        """Keep one more."""
        name = self._proof.name(proved.number)
        outcomes = [plain(each) for each in proved.outcomes]
        row = {"portion": name, "outcomes": outcomes, "rows": proved.rows, "digest": proved.digest}
        scenario = self._proof.scenario(proved.number)
        with self._noted():
            self._folder.mkdir(parents=True, exist_ok=True)
            with self._files[scenario.cell, scenario.recipe].open("a", encoding="utf-8") as file:
                file.write(json.dumps(row, ensure_ascii=False) + "\n")

    def forget(self, *, all: bool) -> None:
        """Remove what recipes left that are not as they were any more, or all."""
        with self._noted():
            for each in self._folder.glob(f"*{SUFFIX}"):
                if all or each not in self._files.values():
                    each.unlink()

    def _read(self) -> Iterator[Proved]:
        lines: list[bytes] = []
        with self._noted():
            for file in (each for each in {*self._files.values()} if each.exists()):
                lines += file.read_bytes().splitlines()
        for line in lines:
            with suppress(ValueError, KeyError, TypeError, IndexError):  # cut off, or not ours
                yield self._proved(json.loads(line))

    @contextmanager
    def _noted(self) -> Iterator[None]:
        """Note an error of the disk, and go on: it is proved again the next time."""
        try:
            yield
        except OSError as error:
            self.trouble = f"{self._folder}: {error.strerror}"

    def _proved(self, row: dict[str, Any]) -> Proved:
        number = self._proof.number(row["portion"])
        found = Proved(
            number=number,
            outcomes=tuple(map(outcome_from, row["outcomes"])),
            rows=tuple(row["rows"]),
            digest=row["digest"],
        )
        if len(found.each) != self._proof.count(number):
            raise ValueError("another number of faults")
        return found
