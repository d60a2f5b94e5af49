"""A modest campaign in many weathers, and which branches its runs went through."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from tests.probes import Probes, Rows

from arboleda.dispatch import ledger
from arboleda.model import cell_states
from arboleda_proofs.simulator.climate import Climate
from arboleda_proofs.simulator.run import Simulation

from .search import plants

HOLDS = ("operator_hold", "operator_resume")
VERBS = (*HOLDS, "operator_retry", "operator_abandon", "operator_cancel", "operator_release")
STOPS = {"operator_stop": 40.0, "operator_clear": 30.0, "operator_reset": 10.0, "operator_hold": 20.0}
LATCHES = {"second_orchestrator": 30.0, "mute": 15.0, "driver_alarm": 15.0, "hop_delay": 10.0}
STRANGERS = {"foreign_retained": 10.0, "second_orchestrator": 8.0, "foreign_halt": 8.0, "hop_delay": 10.0}
PARTS = ("no_grip", "no_part", "piece_false", "piece_flicker", "stuck_effector", "lost_part")


def _mistaken(at: float, arm: str) -> list[dict[str, Any]]:
    """An arm says for some time that it moves, or what it said last; its cell is held, then given up."""
    lie = {"at": at, "seconds": 12.0, "target": f"ra_{arm}", "word": "estado"}
    hold = {"kind": "operator_hold", "at": at + 0.8, "target": f"ra{arm}"}
    give_up = [{**hold, "kind": "operator_abandon", "at": at + late} for late in (5.4, 6.0)]
    return [{"kind": "stuck_bit", **lie}, hold, {**hold, "at": at + 0.2}, *give_up]


MISTAKEN = [each for at in range(3, 60, 14) for arm in "123" for each in _mistaken(at + int(arm) / 3, arm)]
DARK = [
    {"kind": "brown_out", "at": at, "seconds": 45.0, "target": arm}
    for at, arm in ((4, "arm_left"), (7, "arm_back"))
]
UNSEEN = [
    {"kind": "piece_false", "at": at + late, "seconds": 6.0, "target": arm, "word": "nothing"}
    for at in range(3, 60, 7)
    for late, arm in ((0.0, "arm_left"), (1.3, "arm_back"))
]
WEATHERS: dict[str, tuple[range, str | dict[str, Any]]] = {
    "all kinds": (range(1, 13), "many"),
    "verbs": (range(1, 5), {"rates": dict.fromkeys(VERBS, 8.0)}),
    "stops": (range(1, 7), {"rates": {**STOPS, "loss": 20.0}}),
    "lies": (range(1, 9), {"rates": {"lying_telemetry": 20.0, "stuck_bit": 30.0, "operator_hold": 15.0}}),
    "no end of a halt": (range(1, 14, 2), {"faults": MISTAKEN}),
    "latches": (range(1, 7), {"rates": {**LATCHES, "operator_stop": 3.0}}),
    "twice": (range(1, 18), {"rates": {"duplicate": 50.0, "reorder": 30.0, **dict.fromkeys(HOLDS, 60.0)}}),
    "in the dark": (range(2, 13, 2), {"faults": DARK}),
    "overridden": (range(2, 9, 2), {"rates": {"brown_out": 15.0, "operator_override": 40.0}}),
    "parts": (range(2, 9, 2), {"rates": dict.fromkeys(PARTS, 10.0)}),
    "not seen": (range(2, 13, 2), {"faults": UNSEEN}),
    "power": (
        range(1, 11),
        {"rates": {"reboot": 15.0, "brown_out": 8.0, "operator_home": 10.0, **STRANGERS}},
    ),
    "garbage": (range(1, 3), {"rates": {"foreign_garbage": 60.0}}),
    "flood": (range(1, 2), {"faults": [{"kind": "flood_of_tasks", "at": 5.0}]}),
    "teachers": (range(1, 3), {"rates": {"teach": 8.0}}),
    "crashes": (range(1, 9), "crashes"),
    "restarts": (range(1, 3), {"rates": {"plant_crash": 3.0, "operator_stop": 3.0}}),
}

# Runs that reach what few others do. While everything is as it was, no others are needed.
FIRST: tuple[tuple[str, int], ...] = (
    *(("all kinds", seed) for seed in (12, 6, 2, 5, 11, 9)),
    ("stops", 5),
    ("parts", 4),
    ("latches", 2),
    *(("lies", seed) for seed in (3, 4)),
    ("overridden", 4),
    ("no end of a halt", 13),
    ("power", 5),
    ("restarts", 1),
    ("teachers", 1),
    *(("crashes", seed) for seed in (1, 2)),
    ("in the dark", 10),
    ("twice", 17),
    ("garbage", 1),
    ("flood", 1),
    ("verbs", 2),
)


class Fired:
    """Faults and probes that came in the runs of a campaign, by family."""

    def __init__(self) -> None:
        self.kinds: Counter[str] = Counter()
        self.probes: Counter[str] = Counter()
        self.cells = Rows(cell_states.TABLE)
        self.commands = Rows(ledger.TABLE)


def run(patch: pytest.MonkeyPatch, enough: Callable[[Fired], bool]) -> Fired:
    """All weathers, those of FIRST first, until it is enough."""
    fired = Fired()
    patch.setattr(cell_states, "TABLE", fired.cells)
    patch.setattr(ledger, "TABLE", fired.commands)
    for weather, seed in _runs():
        simulation = _simulation(weather, seed)
        probes = Probes(simulation.world)
        result = simulation.run(seconds=60.0)
        fired.kinds.update(fault.kind for fault in result.faults)
        fired.probes.update(probes.fired)
        if enough(fired):
            break
    return fired


def _runs() -> Iterator[tuple[str, int]]:
    yield from FIRST
    yield from (
        run for name, (seeds, _) in WEATHERS.items() for seed in seeds if (run := (name, seed)) not in FIRST
    )


def _simulation(name: str, seed: int) -> Simulation:
    model, weather = plants()[seed % 2], WEATHERS[name][1]
    if isinstance(weather, str):
        climate = Climate.draw(model, seed, weather)
    else:
        climate = Climate.from_file(model, seed, weather)
    return Simulation(model, seed, climate.faults, invariants=())
