"""Drawn plants with cells of devices, each under one of six settings in turn; says what each commit did.

PYTHONPATH=tools:tools/drawn .venv/bin/python -m arboleda_drawn.by_commit FILE COUNT [FIRST]

runs COUNT plants from seed FIRST on (1), of which FILE gets a line for each; with FILE alone it says what
stands there. The same command again goes on where it was; seeds that were run on another commit are run
again.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import count, islice
from pathlib import Path
from typing import Any

from arboleda_proofs.campaigns.setting import Setting
from frame.words import words

from .plants import DrawnPlants

CYCLES = 20
SETTINGS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("--faults none", {"level": "none"}),
    ("--faults normal", {"level": "normal"}),
    ("--faults many", {"level": "many"}),
    ("--faults crashes", {"level": "crashes"}),
    ("--standby", {"level": "normal", "standby": True}),
    ("--any-of", {"level": "normal", "any_of": True}),
)


@dataclass
class Total:
    """Total of one commit: plants, cycles and faults, and the lines of what broke or was found."""

    plants: Counter[str] = field(default_factory=Counter)
    cycles: int = 0
    faults: int = 0
    wrong: list[str] = field(default_factory=list)


def seeds_of_devices(first: int) -> Iterator[int]:
    """The seeds from this one on whose drawn plant has cells of devices."""
    plants = DrawnPlants()
    return (seed for seed in count(first) if plants.of(seed).drawn is not None)


def run(seed: int, commit: str) -> dict[str, Any]:
    """Simulate the plant of a seed; what came of it as plain data."""
    options, given = SETTINGS[seed % len(SETTINGS)]
    result = Setting(plants=DrawnPlants(), cycles=CYCLES, **given).run(seed)
    found = [f"{each.recipe}, {each.step} ({each.reason}): {each.sentence}" for each in result.findings]
    return {
        "commit": commit,
        "seed": seed,
        "options": options,
        "cycles": result.cycles,
        "faults": len(result.faults),
        "broken": None if result.broken is None else str(result.broken),
        "findings": found,
    }


def rows_of(file: Path) -> list[dict[str, Any]]:
    """The lines of a file that may not be there yet."""
    return [json.loads(line) for line in file.read_text().splitlines()] if file.exists() else []


def totals(rows: list[dict[str, Any]]) -> dict[str, Total]:
    """The total of each commit."""
    found: dict[str, Total] = {}
    for row in rows:
        total = found.setdefault(row["commit"], Total())
        total.plants[row["options"]] += 1
        total.cycles += row["cycles"]
        total.faults += row["faults"]
        for each in [row["broken"], *row["findings"]]:
            if each:
                total.wrong.append(f"seed {row['seed']} {row['options']}: {each}")
    return found


def tell(file: Path) -> int:
    """Print what a file says; the number of plants in which something was wrong, of all commits."""
    found = totals(rows_of(file))
    for commit, total in found.items():
        kinds = ", ".join(f"{number} {options}" for options, number in sorted(total.plants.items()))
        amount = f"{total.plants.total()} plants, {total.cycles} cycles, {total.faults} faults"
        print(f"{commit}: {amount} ({kinds})")
        for line in total.wrong:
            print(f"  {line}")
        print(f"  {len(total.wrong)} wrong")
    return sum(len(total.wrong) for total in found.values())


def commit_of(folder: Path) -> str:
    """The commit that is checked out, marked where files differ from it."""
    command = ["git", "-C", str(folder), "describe", "--always", "--dirty", "--exclude", "*"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def main(typed: list[str]) -> int:
    file, number, first = words(__doc__, Path, 0, 1, typed=typed)
    if number:
        commit = commit_of(Path(__file__).parent)
        done = {row["seed"] for row in rows_of(file) if row["commit"] == commit}
        for seed in islice(seeds_of_devices(first), number):
            if seed not in done:
                with file.open("a") as out:
                    out.write(json.dumps(run(seed, commit)) + "\n")
    return 1 if tell(file) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
