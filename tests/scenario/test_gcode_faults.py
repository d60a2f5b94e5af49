"""A plant with a gantry behind GRBL under its faults; `scripts/driver-faults gcode` runs more seeds."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.drivers.gcode import machine
from arboleda.drivers.gcode.lines import Status
from arboleda.kinds.joints.motion import JointMotion
from arboleda.plant_file.loader import load
from arboleda.virtual.gcode.faults import FAULTS
from arboleda_driver_faults.gcode import CAUSES, GantryRig
from arboleda_driver_faults.rig import TASKS, run

from ..lengths import sample

EXAMPLE = load(Path(__file__).parents[2] / "examples/gantry/bench.yaml")
SEEDS = 8
FEW = 1  # task, in which a fault comes by itself


def breaches(seed: int, *names: str, tasks: int = TASKS) -> list[str]:
    return run(GantryRig(EXAMPLE), seed, names, tasks).breaches


@pytest.mark.parametrize("seed", sample(range(SEEDS), every=4))
def test_no_false_success_no_hang_and_the_right_cause(seed: int) -> None:
    assert breaches(seed) == []


@pytest.mark.parametrize("fault", sample(FAULTS, every=3))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_a_machine_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(3) for each in breaches(seed, "lie", "short"))


def test_an_ok_that_is_an_end_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def done(self: machine.Machine, now: float, move: machine.Move, status: Status) -> None:
        if now > move.taken_at:
            self._work = None
            self._tell(done=move.id)

    monkeypatch.setattr(machine.Machine, "_go_on", done)
    assert any("wrong cause" in each for each in breaches(3, "late_start", tasks=2))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(CAUSES) == set(FAULTS)
