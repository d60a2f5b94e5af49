"""The driver `follow_joint_trajectory` without ROS 2: a test plays the action server and the encoders."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from arboleda.drivers import Home, MotionState, MoveJoints, Report, SetEffector, Stop, StopMode
from arboleda.model.plant_model import Evidence, Link
from arboleda.testing.plants import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_drivers.connections.link import CommandNotSent
from arboleda_drivers.joint_trajectory.machine import machine
from arboleda_drivers.joint_trajectory.settings import Settings
from arboleda_drivers.ros_action.events import (
    CancelAll,
    CancelAnswer,
    GoalAnswer,
    GoalList,
    GoalResult,
    ListedGoal,
    SendGoal,
    ServersFound,
    Status,
    UnusableMessage,
)
from arboleda_drivers.ros_action.joints import JointStateEvent

from ..ros_action.action_rig import SERVER, ActionRig

ARM = replace(StorageLayout(shipped("sis_c").cells[0]).arm, link=Link.DRIVER, evidence=Evidence.IDS)
NAMES = tuple(joint.name for joint in ARM.joints)
ZERO = (0.0,) * 6
GOAL = ARM.motion.quantised(tuple(math.radians(each) for each in (10, 20, -30, 0, 5, 0)))
GO = MoveJoints(id="9-1", robot=ARM.name, q=GOAL)
AGAIN = MoveJoints(id="9-2", robot=ARM.name, q=ZERO)
HALT = Stop(id="9-3", robot=ARM.name, mode=StopMode.HALT)


class Rig(ActionRig):
    """An arm, whose joints are measured while they are known."""

    def __init__(self) -> None:
        super().__init__(machine([ARM], Settings()))
        self.q: tuple[float, ...] | None = ZERO
        self.wait(0.5)

    def measure(self) -> None:
        if self.q is not None:
            self.tell(self.joints(self.q))

    def joints(self, q: tuple[float, ...]) -> JointStateEvent:
        return JointStateEvent(names=NAMES, positions=q, stamp=(int(self.now * 1000), 0))

    def under_way(self) -> None:
        self.begin(GO)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_a_move_is_one_point_that_keeps_the_speed_limits(rig: Rig) -> None:
    goal = next(each for each in rig.ask(GO) if isinstance(each, SendGoal)).goal
    assert (goal.joints, goal.q) == (NAMES, GOAL)
    for joint, q in zip(ARM.joints, GOAL, strict=True):
        assert 15 / 8 * abs(q) / goal.duration_s <= joint.speed * 0.5 + 1e-9
        assert 10 / math.sqrt(3) * abs(q) / goal.duration_s**2 <= joint.acceleration * 0.5 + 1e-9


def test_it_is_done_once_the_result_and_later_joints_say_so(rig: Rig) -> None:
    rig.under_way()
    rig.q = GOAL
    rig.wait(0.5)
    assert (rig.last.accepted, rig.last.done, rig.last.state) == (GO.id, None, MotionState.MOVING)
    rig.tell(GoalResult(id=GO.id, status=Status.SUCCEEDED))
    assert rig.last.done is None
    rig.wait(0.05)
    assert (rig.last.done, rig.last.q) == (GO.id, GOAL)


def test_a_server_that_lies_is_not_believed_while_the_arm_moves(rig: Rig) -> None:
    rig.under_way()
    rig.tell(GoalResult(id=GO.id, status=Status.SUCCEEDED))
    for step in range(10):
        rig.q = (0.01 * step, *ZERO[1:])
        rig.wait(0.1)
        assert rig.last.done is None and rig.last.state is MotionState.MOVING
    rig.wait(0.5)
    assert rig.last.done == GO.id and not ARM.motion.stands_at(
        rig.last.q, GOAL
    )  # so the plant says: not reached
    assert rig.count(CancelAll) == 1  # of what such a server may still go on with


@pytest.mark.parametrize(
    ("end", "failure"),
    [
        (
            GoalResult(id=GO.id, status=Status.ABORTED, error=-4, text="elbow"),
            "path_tolerance_violated elbow",
        ),
        (GoalResult(id=GO.id, status=Status.ABORTED), "aborted"),
        (GoalResult(id=GO.id, status=Status.SUCCEEDED, error=-5), "goal_tolerance_violated"),
        (GoalResult(id=GO.id, status=Status.CANCELED), "cancelled_by_another_client"),
    ],
)
def test_any_other_end_is_a_failure_with_its_word(rig: Rig, end: GoalResult, failure: str) -> None:
    rig.under_way()
    rig.tell(end)
    assert (rig.last.failed, rig.last.failure, rig.last.done) == (GO.id, failure, None)


def test_a_goal_that_is_refused_is_rejected(rig: Rig) -> None:
    rig.ask(GO)
    rig.tell(GoalAnswer(id=GO.id, accepted=False))
    assert (rig.last.rejected, rig.last.refusal) == (GO.id, "goal_refused")


def test_a_second_goal_is_refused_while_one_is_open(rig: Rig) -> None:
    rig.under_way()
    rig.ask(AGAIN)
    assert (rig.last.rejected, rig.last.refusal) == (AGAIN.id, "busy")
    assert rig.count(SendGoal) == 1


def test_the_end_of_another_goal_ends_none(rig: Rig) -> None:
    rig.under_way()
    rig.tell(GoalResult(id="8-1", status=Status.SUCCEEDED))
    rig.q = GOAL
    rig.wait(1)
    assert rig.last.done is None


def test_a_goal_that_is_stopped_before_it_is_accepted_is_cancelled_again_after(rig: Rig) -> None:
    rig.ask(GO)
    assert CancelAll() in rig.ask(HALT)
    rig.tell(CancelAnswer(refused=False))
    assert CancelAll() in rig.tell(GoalAnswer(id=GO.id, accepted=True))
    assert rig.last.accepted == HALT.id and rig.last.state is MotionState.MOVING
    rig.tell(CancelAnswer(refused=False), GoalResult(id=GO.id, status=Status.CANCELED))
    assert (rig.last.state, rig.last.done, rig.last.failed) == (MotionState.STOPPED, None, None)


def test_a_goal_accepted_after_it_was_given_up_is_cancelled(rig: Rig) -> None:
    rig.ask(GO)
    rig.wait(2.1)
    assert rig.last.failure == "goal_not_answered"
    assert CancelAll() in rig.tell(GoalAnswer(id=GO.id, accepted=True))


def test_a_stop_that_is_refused_is_said_and_asked_for_again(rig: Rig) -> None:
    rig.under_way()
    rig.ask(HALT)
    rig.tell(CancelAnswer(refused=True))
    assert (rig.last.rejected, rig.last.refusal) == (HALT.id, "cancel_refused")
    rig.wait(2.1)
    assert rig.count(CancelAll) == 2 and rig.last.state is MotionState.MOVING


def test_a_stop_that_is_not_answered_is_asked_for_again(rig: Rig) -> None:
    rig.ask(HALT)
    rig.wait(2.1)
    assert rig.count(CancelAll) == 2 and rig.last.state is MotionState.MOVING


def test_a_stopped_goal_without_a_result_is_over_once_the_arm_rests(rig: Rig) -> None:
    rig.under_way()
    rig.ask(HALT)
    rig.tell(CancelAnswer(refused=False))
    rig.wait(1)
    assert rig.last.state is MotionState.MOVING
    rig.wait(2)
    assert rig.last.state is MotionState.STOPPED


def test_a_latch_shows_until_it_is_cleared(rig: Rig) -> None:
    rig.ask(replace(HALT, mode=StopMode.LATCH))
    rig.tell(CancelAnswer(refused=False))
    assert rig.last.state is MotionState.STOP_LATCHED
    rig.ask(replace(HALT, id="9-4", mode=StopMode.CLEAR))
    assert (rig.last.accepted, rig.last.state) == ("9-4", MotionState.STOPPED)


def test_an_arm_that_somebody_else_moves_is_moving(rig: Rig) -> None:
    assert rig.last.state is MotionState.STOPPED
    rig.q = (0.1, *ZERO[1:])
    rig.wait(0.2)
    assert rig.last.state is MotionState.MOVING


def test_nothing_is_told_of_an_arm_before_it_is_known_whether_it_moves() -> None:
    machine_, states = machine([ARM], Settings()), []
    for step in range(8):
        now = 100.0 + step * 0.05
        joints = JointStateEvent(names=NAMES, positions=(step * 0.01, *ZERO[1:]), stamp=(step, 0))
        said = machine_.step(now, [ServersFound(servers=(SERVER,)), joints])
        states += [each.state for each in said if isinstance(each, Report) and each.q is not None]
    assert states == [MotionState.MOVING]


def listed(goal_status: Status | None) -> GoalList:
    return GoalList(goals=(ListedGoal(uuid=bytes(16), stamp=(1, 0), status=goal_status),))


def test_a_goal_of_before_that_has_no_end_counts_as_motion_until_it_is_cancelled(rig: Rig) -> None:
    rig.tell(listed(None))
    rig.wait(0.2)
    assert rig.last.state is MotionState.MOVING, "it may wait at an obstacle"
    rig.ask(HALT)
    rig.tell(CancelAnswer(refused=False))
    rig.tell(listed(None))
    rig.wait(0.2)
    assert rig.last.state is MotionState.STOPPED, "the list may be late"


def test_a_goal_of_before_that_has_ended_is_none(rig: Rig) -> None:
    rig.tell(listed(Status.SUCCEEDED))
    rig.wait(0.2)
    assert rig.last.state is MotionState.STOPPED


@pytest.mark.parametrize(
    ("servers", "why"),
    [((), "there is no action server"), ((7, 8), "there are 2 action servers")],
)
def test_a_server_that_vanishes_or_has_a_double_is_no_link(
    rig: Rig, servers: tuple[int, ...], why: str
) -> None:
    rig.under_way()
    rig.servers = servers
    rig.wait(1.2)
    assert rig.last.state is MotionState.NO_LINK and why in str(rig.last.lost)
    assert isinstance(rig.ask(AGAIN)[0], CommandNotSent)


def test_joints_that_fall_silent_are_no_link_and_the_goal_is_cancelled_on_return(rig: Rig) -> None:
    rig.under_way()
    rig.q = None
    rig.wait(1.2)
    assert rig.last.state is MotionState.NO_LINK and rig.count(CancelAll) == 0
    rig.q = ZERO
    rig.wait(0.1)
    assert rig.last.state is MotionState.MOVING and rig.count(CancelAll) == 1


def test_a_server_that_knows_no_such_goal_has_lost_it_where_no_other_is_found(rig: Rig) -> None:
    rig.under_way()
    rig.tell(GoalResult(id=GO.id, status=Status.UNKNOWN))
    rig.wait(0.9)
    assert (rig.last.failed, rig.last.state) == (None, MotionState.MOVING)
    rig.wait(0.2)
    assert (rig.last.failed, rig.last.failure) == (GO.id, "goal_unknown_to_the_server")


def test_a_server_that_knows_no_such_goal_and_is_another_one_is_a_boot(rig: Rig) -> None:
    """Asked for the end of a goal, a server that was started anew may answer before it is looked for."""
    rig.under_way()
    before = rig.last.boot_id
    rig.tell(GoalResult(id=GO.id, status=Status.UNKNOWN))
    rig.servers = (SERVER + 1,)
    rig.wait(2)
    assert rig.last.boot_id != before
    assert (rig.last.failed, rig.last.state) == (None, MotionState.STOPPED)


def test_a_server_that_is_started_anew_is_a_boot_and_knows_no_goal(rig: Rig) -> None:
    rig.under_way()
    before = rig.last.boot_id
    rig.servers = (8,)
    rig.wait(1)
    assert rig.last.boot_id != before and rig.last.accepted is None
    assert rig.last.state is MotionState.STOPPED and rig.count(CancelAll) == 0


@pytest.mark.parametrize(
    "seen",
    [
        JointStateEvent(names=NAMES[:5], positions=ZERO[:5], stamp=(1, 0)),
        JointStateEvent(names=NAMES, positions=ZERO[:5], stamp=(1, 0)),
        JointStateEvent(names=NAMES, positions=(math.nan, *ZERO[1:]), stamp=(1, 0)),
        JointStateEvent(names=(), positions=(), stamp=(1, 0)),
    ],
)
def test_a_joint_state_that_cannot_be_the_arms_changes_nothing(rig: Rig, seen: JointStateEvent) -> None:
    rig.q = None
    for _ in range(12):
        rig.wait(0.1)
        rig.tell(seen)
    assert rig.last.state is MotionState.NO_LINK


def test_a_joint_state_that_is_repeated_with_its_stamp_is_no_news(rig: Rig) -> None:
    frozen = rig.joints(ZERO)
    rig.q = None
    for _ in range(12):
        rig.wait(0.1)
        rig.tell(frozen)
    assert rig.last.state is MotionState.NO_LINK


def test_joints_in_another_order_and_among_others_are_found(rig: Rig) -> None:
    names, q = ("gripper", *reversed(NAMES)), (9.0, *reversed(GOAL))
    rig.tell(JointStateEvent(names=names, positions=q, stamp=(1, 0)))
    rig.q = None
    rig.wait(0.15)
    assert rig.last.q == GOAL


def test_home_is_done_with_the_next_joints(rig: Rig) -> None:
    rig.ask(Home(id="9-5", robot=ARM.name))
    assert (rig.last.accepted, rig.last.homed) == ("9-5", False)
    rig.wait(0.1)
    assert (rig.last.done, rig.last.homed) == ("9-5", True)


def test_an_effector_is_not_what_it_moves(rig: Rig) -> None:
    news = rig.ask(SetEffector(id="9-6", robot=ARM.name, on=True))
    assert "no word for SetEffector" in next(each.why for each in news if isinstance(each, CommandNotSent))


def test_settings_that_do_not_fit_are_said() -> None:
    said = [sentence for _, sentence in Settings(joints=("a", "b")).problems(ARM)]
    assert said == [f"there are 2 names for the 6 joints of {ARM.name}"]
    with pytest.raises(ValueError, match="speed_percent is 0"):
        Settings(speed_percent=0)


def test_what_cannot_be_taken_has_lost_the_goal_which_is_cancelled(rig: Rig) -> None:
    rig.under_way()
    said = rig.tell(UnusableMessage(why="it has said what cannot be taken, 7 (TypeError: no joints)"))
    assert str(said[0].lost) == "it has said what cannot be taken, 7 (TypeError: no joints)"  # type: ignore[union-attr]
    assert rig.count(CancelAll) == 1
    rig.tell(GoalResult(id=GO.id, status=Status.SUCCEEDED))
    rig.wait(0.5)
    assert rig.last.done is None
