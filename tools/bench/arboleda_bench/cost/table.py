"""Table of pinned costs: for each scenario its calls, and the functions that make most of them."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from .counter import Calls

FOLDER = Path(__file__).parent
ALLOWED = 0.02  # a scenario may have so many more calls than are pinned
LEAST_SHARE = 0.002  # of the calls of its scenario, for a function to be in the table
NAMED = 6  # functions that grew, in a finding


@dataclass(frozen=True, kw_only=True)
class Cost:
    """The cost of a scenario: all its calls, and those of the functions that are called most.

    `different` counts the functions of each act once, and adds that up over the acts: what an act costs with
    cold caches.
    """

    calls: int
    different: int
    functions: Mapping[str, int]

    @classmethod
    def of(cls, acts: Sequence[Calls]) -> Cost:
        """The cost from the counted calls of each act; the rarest functions are left out."""
        calls = sum(acts, Counter[str]())
        most = sorted(calls.items(), key=lambda each: (-each[1], each[0]))
        least = LEAST_SHARE * calls.total()
        functions = {name: number for name, number in most if number >= least}
        return cls(calls=calls.total(), different=sum(map(len, acts)), functions=functions)


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """A scenario's cost beside the pinned one, which is None for a scenario that is new."""

    name: str
    pinned: Cost | None
    now: Cost

    @property
    def growth(self) -> float:
        """The share by which the calls have grown; below 0 if there are fewer."""
        return 0.0 if self.pinned is None else self.now.calls / self.pinned.calls - 1

    @property
    def spread(self) -> float:
        """The share by which the different functions have grown."""
        return 0.0 if self.pinned is None else self.now.different / self.pinned.different - 1

    @property
    def is_dearer(self) -> bool:
        """True if the lock fails: more calls or functions than allowed, or no pinned cost at all."""
        if self.pinned is None:
            return True
        more = 1 + ALLOWED
        return self.now.calls > self.pinned.calls * more or self.now.different > self.pinned.different * more

    @property
    def is_cheaper(self) -> bool:
        """True if the cost should be pinned anew, so that it stays low."""
        return min(self.growth, self.spread) < -ALLOWED

    def grown(self) -> list[str]:
        """The functions that grew most, one line each."""
        if self.pinned is None:
            return []
        rare = round(LEAST_SHARE * self.pinned.calls)
        rows = []
        for name, number in self.now.functions.items():
            before = self.pinned.functions.get(name)
            more = number - (rare if before is None else before)
            if more > 0:
                was = f"at most {rare:,}" if before is None else f"{before:,}"
                rows.append((more, f"{number:,} calls, pinned {was}: {name}"))
        return [line for _, line in sorted(rows, reverse=True)[:NAMED]]


def file_for(python: str) -> Path:
    """The table for a version of Python, such as "3.11": each makes other calls of the same code."""
    return FOLDER / f"python{python}.json"


def read(file: Path) -> dict[str, Cost]:
    """The pinned costs by scenario; empty if there is no such file."""
    if not file.exists():
        return {}
    rows: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return {name: Cost(**row) for name, row in rows.items()}


def write(file: Path, costs: Mapping[str, Cost]) -> None:
    """Pin these costs."""
    rows = {name: asdict(cost) for name, cost in costs.items()}
    file.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
