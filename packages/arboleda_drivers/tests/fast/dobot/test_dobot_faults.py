"""A plant with a Dobot under the faults of its controller; `tools/driver-faults dobot` runs more seeds."""

from __future__ import annotations

import pytest
from tests.lengths import sample

from arboleda.kinds.joints.motion import JointMotion
from arboleda.testing.plants import shipped
from arboleda_driver_faults.dobot import CAUSES, DobotRig
from arboleda_driver_faults.rig import TASKS, run
from arboleda_drivers.connections.look import Look
from arboleda_drivers.dobot import work
from arboleda_drivers.dobot.frames import Feedback, Mode
from arboleda_drivers.dobot.virtual.faults import FAULTS

SHIPPED = shipped()
SEEDS = 12
FEW = 2  # tasks, in which a fault comes by itself


def breaches(seed: int, *names: str, tasks: int = TASKS) -> list[str]:
    return run(DobotRig(SHIPPED), seed, names, tasks).breaches


@pytest.mark.parametrize("seed", sample(range(SEEDS), every=4))
def test_no_false_success_no_hang_and_the_right_cause(seed: int) -> None:
    assert breaches(seed) == []


@pytest.mark.sampled(13)
@pytest.mark.parametrize("fault", sample(FAULTS, every=2))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_an_arm_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(5) for each in breaches(seed, "lie", "short"))


def test_an_end_without_its_number_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def idle(self: work.Move, now: float, feedback: Feedback) -> Look:
        return Look(done=self.number is not None and feedback.mode is Mode.IDLE)

    monkeypatch.setattr(work.Move, "look", idle)
    assert any("wrong cause" in each for each in breaches(0, "late_start"))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(CAUSES) == set(FAULTS)
