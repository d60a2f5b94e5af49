"""Simulation of a draft: `arboleda simulate` on some seeds, with faults."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from arboleda_proofs.simulator.run import Result

from ..plants import Plant, PlantRotation
from ..setting import Setting
from .process import errand, say, write

RESULT = "result.json"
LEVEL = "normal"  # of faults


def main() -> None:
    """Run the errand of this process."""
    with errand() as given:
        model, files = given.plant()
        plant = Plant(declared=model, files=files)
        rows = [*simulated(plant, given.wanted["seeds"], given.wanted["cycles"])]
        write(given.folder / RESULT, {"seeds": rows, "held": not any(map(is_bad, rows))})


def simulated(plant: Plant, seeds: int, cycles: int) -> Iterator[dict[str, Any]]:
    """Rows of seeds, from 1 on: the rule that broke, and tasks that failed before any fault came."""
    setting = Setting(plants=PlantRotation(plants=(plant,)), cycles=cycles, level=LEVEL)
    for seed in range(1, seeds + 1):
        say(doing="simulating", done=seed - 1, total=seeds)
        yield _row(setting.run(seed))


def _row(result: Result) -> dict[str, Any]:
    broken = result.broken
    return {
        "seed": result.seed,
        "faults": len(result.faults),
        "broken": None if broken is None else {"invariant": broken.invariant, "sentence": str(broken)},
        "findings": [f"{each.kind.value}: {each.step}: {each.sentence}" for each in result.findings],
    }


def is_bad(row: dict[str, Any]) -> bool:
    """True for a seed that broke a rule, or found a task that fails where nothing had gone wrong."""
    return bool(row["broken"] or row["findings"])
