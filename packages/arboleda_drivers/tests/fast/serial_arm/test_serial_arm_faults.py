"""A plant with an arm of bus servos under faults; `tools/driver-faults serial_arm-feetech` runs more."""

from __future__ import annotations

from typing import Literal

import pytest
from tests.lengths import sample
from tests.packages import ROOT

from arboleda.kinds.joints.motion import JointMotion
from arboleda.plant_file.loader import load
from arboleda_driver_faults.rig import TASKS, run
from arboleda_driver_faults.serial_arm import CAUSES, ServoRig
from arboleda_drivers.connections.look import Look
from arboleda_drivers.serial_arm import work
from arboleda_drivers.serial_arm.position_watch import PositionWatch
from arboleda_drivers.serial_arm.virtual.faults import FAULTS

EXAMPLE = load(ROOT / "examples/serial_arm/desk.yaml")
SEEDS = 4
FEW = 1  # task, in which a fault comes by itself
HALF = TASKS // 2
Maker = Literal["feetech", "dynamixel"]
MAKERS = pytest.mark.parametrize("maker", ["feetech", "dynamixel"])


def breaches(seed: int, *names: str, maker: Maker = "feetech", tasks: int = TASKS) -> list[str]:
    return run(ServoRig(EXAMPLE, maker), seed, names, tasks).breaches


@pytest.mark.sampled(2)
@MAKERS
@pytest.mark.parametrize("seed", sample(range(SEEDS), every=4))
def test_no_false_success_no_hang_and_the_right_cause(maker: Maker, seed: int) -> None:
    assert breaches(seed, maker=maker, tasks=HALF) == []


@pytest.mark.sampled(4)
@pytest.mark.parametrize("fault", sample(FAULTS, every=3))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_an_arm_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)
    monkeypatch.setattr(PositionWatch, "stuck", lambda self: [])
    assert any("false success" in each for each in breaches(1, "stall", tasks=HALF))


def test_a_move_that_is_done_at_once_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def done(self: work.Move, now: float, picture: work.Picture) -> Look:
        return Look(accepted=True, done=True)

    monkeypatch.setattr(work.Move, "look", done)
    assert breaches(1, "part", tasks=FEW) != []


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(CAUSES) == set(FAULTS)
