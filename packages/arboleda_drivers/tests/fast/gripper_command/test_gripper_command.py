"""The driver `gripper_command` without ROS 2: a test plays the action server and the finger's encoder."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from arboleda.drivers import MotionState, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.kinds.gripper import GripperSettings, gripper
from arboleda.model.commands import Command
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drivers.gripper_command.machine import Width, machine
from arboleda_drivers.gripper_command.settings import Settings
from arboleda_drivers.ros_action.events import (
    CancelAll,
    CancelAnswer,
    GoalAnswer,
    GoalResult,
    SendGoal,
    Status,
)
from arboleda_drivers.ros_action.joints import JointStateEvent

from ..ros_action.action_rig import ActionRig

JAW = Device(
    name="jaw",
    mqtt="jaw",
    link=Link.DRIVER,
    evidence=Evidence.IDS,
    timeout_s=5.0,
    kind=gripper.of(GripperSettings()),
)
SETTINGS = Settings(open=0.0, closed=0.8)  # rad, as of a Robotiq 2F-85
OPEN_MM, PART_MM = 85.0, 40.0
HALT = Stop(id="9-9", robot="jaw", mode=StopMode.HALT)


def told(id: str, verb: str, **values: Any) -> Command:
    return JAW.kind.command(id=id, robot="jaw", verb=verb, values=values)


CLOSE, OPEN = told("9-1", "close", width_mm=10.0, force_n=30.0), told("9-2", "open")
STALLED = GoalResult(id=CLOSE.id, status=Status.ABORTED, stalled=True)


class Rig(ActionRig):
    """A gripper, whose finger is measured."""

    def __init__(self, settings: Settings = SETTINGS) -> None:
        super().__init__(machine([JAW], settings))
        self.settings, self.mm = settings, OPEN_MM
        self.wait(0.5)

    def measure(self) -> None:
        position = self.settings.position(self.mm)
        stamp = (int(self.now * 1000), 0)
        self.tell(JointStateEvent(names=("finger_joint",), positions=(position,), stamp=stamp))

    def grip(self, end: GoalResult = STALLED, at_mm: float = PART_MM) -> None:
        """It closes, comes to rest there, and the server says that end of it."""
        self.begin(CLOSE)
        self.mm = at_mm
        self.wait(0.2)
        self.tell(end)
        self.wait(0.5)

    @property
    def gripped(self) -> object:
        return self.last.fact("gripped")


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_a_goal_has_the_position_of_its_width_and_the_force(rig: Rig) -> None:
    goal: Width = next(each.goal for each in rig.ask(CLOSE) if isinstance(each, SendGoal))
    assert goal.position == pytest.approx(0.8 * (1 - 10 / 85))
    assert (goal.joint, goal.effort) == ("finger_joint", 30.0)


@pytest.mark.parametrize("status", [Status.ABORTED, Status.SUCCEEDED])
def test_fingers_that_rest_before_their_width_have_a_part_however_the_goal_ends(
    rig: Rig, status: Status
) -> None:
    rig.grip(replace(STALLED, status=status))
    assert (rig.gripped, rig.last.fact("width_mm"), rig.last.done) == (True, PART_MM, CLOSE.id)


def test_fingers_that_come_to_their_width_have_none(rig: Rig) -> None:
    rig.grip(GoalResult(id=CLOSE.id, status=Status.SUCCEEDED), at_mm=10)
    assert (rig.gripped, rig.last.failed, rig.last.failure) == (False, CLOSE.id, "nothing_gripped")


def test_a_server_that_lies_of_fingers_that_have_not_moved_is_not_believed(rig: Rig) -> None:
    rig.grip(at_mm=OPEN_MM)
    assert (rig.gripped, rig.last.failure) == (False, "nothing_gripped")


def test_fingers_that_move_on_after_the_result_have_nothing_yet(rig: Rig) -> None:
    rig.begin(CLOSE)
    rig.tell(STALLED)
    for mm in range(80, 50, -1):
        rig.mm = mm
        rig.wait(0.05)
        assert rig.gripped is None and rig.last.done is None and rig.last.state is MotionState.MOVING


def test_a_part_beyond_what_a_part_can_be_is_none() -> None:
    rig = Rig(replace(SETTINGS, narrowest_mm=45.0))
    rig.grip(at_mm=40)
    assert (rig.gripped, rig.last.failure) == (False, "nothing_gripped")


def test_a_part_that_slips_out_is_seen_by_its_fingers(rig: Rig) -> None:
    rig.grip()
    rig.mm = 10
    rig.wait(0.1)
    assert rig.gripped is False


def test_whether_there_is_a_part_is_not_said_while_it_opens(rig: Rig) -> None:
    rig.grip()
    rig.begin(OPEN)
    rig.wait(0.5)
    assert rig.gripped is None
    rig.mm = OPEN_MM
    rig.tell(GoalResult(id=OPEN.id, status=Status.SUCCEEDED))
    rig.wait(0.1)
    assert (rig.gripped, rig.last.done) == (False, OPEN.id)


def test_it_is_not_known_at_the_start(rig: Rig) -> None:
    assert rig.gripped is None and rig.last.state is MotionState.STOPPED


def test_an_opening_that_ends_elsewhere_fails(rig: Rig) -> None:
    rig.grip()
    rig.begin(OPEN)
    rig.mm = 60
    rig.tell(GoalResult(id=OPEN.id, status=Status.SUCCEEDED))
    rig.wait(0.5)
    assert (rig.last.failed, rig.last.failure, rig.gripped) == (OPEN.id, "width_not_reached", None)


def test_an_opening_that_stalls_fails(rig: Rig) -> None:
    rig.begin(OPEN)
    rig.tell(replace(STALLED, id=OPEN.id))
    assert (rig.last.failed, rig.last.failure) == (OPEN.id, "stalled")


def test_a_new_goal_takes_the_place_of_one_that_does_not_end(rig: Rig) -> None:
    rig.begin(CLOSE)
    assert any(isinstance(each, SendGoal) and each.id == OPEN.id for each in rig.ask(OPEN))
    assert (rig.last.failed, rig.last.failure) == (CLOSE.id, "replaced_by_the_next")
    rig.tell(GoalAnswer(id=OPEN.id, accepted=True), GoalResult(id=CLOSE.id, status=Status.CANCELED))
    assert rig.last.accepted == OPEN.id and rig.last.failed == CLOSE.id


def test_a_goal_that_does_not_end_in_its_time_is_given_up_and_cancelled(rig: Rig) -> None:
    rig.begin(OPEN)
    rig.mm = 60
    rig.wait(5.6)
    assert (rig.last.failed, rig.last.failure) == (OPEN.id, "not_ended")
    assert CancelAll() in rig.said and rig.last.state is MotionState.MOVING
    rig.tell(CancelAnswer(refused=False))
    rig.wait(0.1)
    assert (rig.last.state, rig.gripped) == (MotionState.STOPPED, None)


def test_after_a_stop_under_way_nobody_knows_whether_there_is_a_part(rig: Rig) -> None:
    rig.begin(CLOSE)
    rig.mm = 60
    rig.wait(0.2)
    assert CancelAll() in rig.ask(HALT)
    rig.tell(CancelAnswer(refused=False), GoalResult(id=CLOSE.id, status=Status.CANCELED))
    rig.wait(0.5)
    assert (rig.gripped, rig.last.state) == (None, MotionState.STOPPED)


def test_a_goal_that_is_refused_changes_nothing(rig: Rig) -> None:
    rig.grip()
    rig.ask(OPEN)
    rig.tell(GoalAnswer(id=OPEN.id, accepted=False))
    assert (rig.last.rejected, rig.last.refusal, rig.gripped) == (OPEN.id, "goal_refused", True)


def test_a_width_within_the_tolerance_is_the_one_that_was_told(rig: Rig) -> None:
    rig.grip(at_mm=10.4)
    assert rig.last.fact("width_mm") == 10.0


def test_settings_that_do_not_fit_are_said() -> None:
    arm = replace(StorageLayout(shipped("sis_c").cells[0]).arm, evidence=Evidence.IDS)
    assert [said for _, said in SETTINGS.problems(arm)] == [
        f"{arm.name} is of no declared kind; a gripper is, as kind: gripper"
    ]
    assert list(SETTINGS.problems(JAW)) == []
    with pytest.raises(ValueError, match="two positions"):
        Settings(open=0.1, closed=0.1)
