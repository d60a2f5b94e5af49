"""An arm and a gripper behind actions of ROS 2, under faults; `tools/driver-faults` runs more seeds."""

from __future__ import annotations

import pytest
from tests.lengths import sample
from tests.packages import ROOT

from arboleda.kinds.joints.motion import JointMotion
from arboleda.plant_file.loader import load
from arboleda_driver_faults.gripper import ARM_CAUSES, GRIPPER_CAUSES, CarryRig
from arboleda_driver_faults.rig import TASKS, run
from arboleda_driver_faults.ros_action import CAUSES
from arboleda_drivers.gripper_command.machine import GripperMover
from arboleda_drivers.gripper_command.virtual.machine import FAULTS as GRIPPER_FAULTS
from arboleda_drivers.joint_trajectory.virtual.machine import FAULTS as ARM_FAULTS
from arboleda_drivers.ros_action import machine

EXAMPLE = load(ROOT / "examples/ros2_control/plant.yaml")
SEEDS = 4
FEW = 2  # tasks, in which a fault comes by itself
PART_MM = 40.0
OWN = ("jaw.empty", "jaw.slip", "jaw.jam", "jaw.allow_stalling", "arm.no_joint", "jaw.no_joint")


def breaches(seed: int, *names: str, tasks: int = TASKS) -> list[str]:
    return run(CarryRig(EXAMPLE), seed, names, tasks).breaches


@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(SEEDS))
def test_no_false_success_no_hang_and_the_right_cause(seed: int) -> None:
    assert breaches(seed) == []


@pytest.mark.sampled(13)
@pytest.mark.parametrize("fault", sample([*(f"arm.{name}" for name in CAUSES), *OWN], every=2))
def test_every_fault_by_itself(fault: str) -> None:
    assert breaches(1, fault, tasks=FEW) == []


def test_an_arm_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(JointMotion, "stands_at", lambda self, position, goal: True)
    assert any("false success" in each for seed in range(3) for each in breaches(seed, "arm.lie"))


def test_a_grip_that_is_believed_anywhere_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(GripperMover, "objection", lambda self, goal: "")
    monkeypatch.setattr(
        GripperMover,
        "shows",
        lambda self, *, busy: {"facts": () if busy else (("gripped", self.width_mm < PART_MM),)},
    )
    assert any("wrong cause" in each for each in breaches(1, "jaw.empty"))


@pytest.mark.long
def test_a_switch_that_is_never_given_up_would_be_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(machine, "SPARE_S", 1e6)
    assert any("hang" in each for seed in range(4) for each in breaches(seed, "jaw.stall"))


def test_every_fault_has_the_reasons_that_it_may_give() -> None:
    assert set(ARM_CAUSES) == set(ARM_FAULTS) and set(GRIPPER_CAUSES) == set(GRIPPER_FAULTS)
