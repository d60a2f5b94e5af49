"""Virtual action servers of ROS 2 without ROS 2: goals, motion that takes its time, what clients are told."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection

import pytest

from arboleda.model.errors import StartError
from arboleda_drivers.gripper_command.virtual import machine as gripper
from arboleda_drivers.gripper_command.virtual.machine import Grip, GripperBody
from arboleda_drivers.joint_trajectory.virtual import machine as trajectory
from arboleda_drivers.joint_trajectory.virtual.machine import ArmBody, Points
from arboleda_drivers.joint_trajectory.virtual.server import controller
from arboleda_drivers.nav2.localisation import MapPose, OdometryPose
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.virtual import machine as nav2
from arboleda_drivers.nav2.virtual.machine import BaseBody, Drive
from arboleda_drivers.ros_action.events import GoalAnswer, GoalResult, Measurement, Status
from arboleda_drivers.ros_action.joints import JointStateEvent
from arboleda_drivers.ros_action.virtual.machine import (
    CancelDecision,
    CancelRequest,
    GoalRequest,
    VirtualServer,
)
from arboleda_drivers.virtual.faults import Faults

NAMES = ("a", "b")
AWAY = Points(joints=("b", "a"), points=((1.0, (0.2, 0.1)), (3.0, (0.4, 0.2))))


class Rig:
    """A server under a clock that the test moves."""

    def __init__(self, server: VirtualServer) -> None:
        self.server, self.now = server, 100.0
        self.said: list[object] = []
        self.wait(0.1)

    def wait(self, s: float) -> None:
        end = self.now + s
        while self.now < end - 1e-9:
            self.now = min(end, self.now + 0.05)
            self.said += self.server.step(self.now, [])

    def ask(self, goal: object, id: str = "1") -> None:
        self.said += self.server.step(self.now, [GoalRequest(id=id, goal=goal)])

    def cancel(self, id: str = "1") -> None:
        self.said += self.server.step(self.now, [CancelRequest(id=id)])

    def of(self, kind: type) -> list[object]:
        return [each for each in self.said if isinstance(each, kind)]


def arm(faults: Collection[str] = ()) -> Rig:
    return Rig(VirtualServer(ArmBody(NAMES, faults), faults))


def fingers(*faults: str) -> Rig:
    on = Faults(gripper.FAULTS, faults)
    return Rig(VirtualServer(GripperBody("finger", on), on))


def test_a_trajectory_takes_its_time_and_passes_its_points_in_the_order_of_its_joints() -> None:
    rig = arm()
    rig.ask(AWAY)
    assert rig.of(GoalAnswer) == [GoalAnswer(id="1", accepted=True)]
    rig.wait(1.0)
    assert rig.server.body.position == pytest.approx((0.1, 0.2))
    rig.wait(1.9)
    assert rig.of(GoalResult) == []
    rig.wait(0.2)
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.SUCCEEDED)]
    assert rig.server.body.position == pytest.approx((0.2, 0.4))


@pytest.mark.parametrize(
    "goal",
    [
        Points(joints=("a", "c"), points=AWAY.points),
        Points(joints=NAMES, points=()),
        Points(joints=NAMES, points=((1.0, (0.1,)),)),
        Points(joints=NAMES, points=((0.0, (0.1, 0.1)),)),
        Points(joints=NAMES, points=((2.0, (0.1, 0.1)), (1.0, (0.2, 0.2)))),
        Points(joints=NAMES, points=((1.0, (math.nan, 0.1)),)),
    ],
)
def test_a_trajectory_that_cannot_be_is_refused(goal: Points) -> None:
    rig = arm()
    rig.ask(goal)
    assert rig.of(GoalAnswer) == [GoalAnswer(id="1", accepted=False)]


def test_a_cancel_stops_it_where_it_is_and_what_it_measures_says_so() -> None:
    rig = arm()
    rig.ask(AWAY)
    rig.wait(1.5)
    rig.cancel()
    at = rig.server.body.position
    rig.wait(1)
    assert rig.of(CancelDecision) == [CancelDecision(id="1", accepted=True)]
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.CANCELED)]
    last = rig.of(Measurement)[-1]
    assert isinstance(last, JointStateEvent) and last.positions == rig.server.body.position == at


def test_a_second_goal_takes_the_place_of_the_first() -> None:
    rig = arm()
    rig.ask(AWAY)
    rig.wait(1)
    rig.ask(Points(joints=NAMES, points=((1.0, (0.0, 0.0)),)), id="2")
    rig.wait(1.1)
    assert [(each.id, each.status) for each in rig.of(GoalResult)] == [  # type: ignore[attr-defined]
        ("1", Status.CANCELED),
        ("2", Status.SUCCEEDED),
    ]


def test_fingers_stall_at_a_part_and_go_on_once_it_slips() -> None:
    rig = fingers()
    rig.ask(Grip(position=0.0))
    rig.wait(3)
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.ABORTED, stalled=True)]
    assert rig.server.body.position == (0.04,)
    assert isinstance(rig.server.faults, Faults)
    rig.server.faults.switch("slip", on=True)
    rig.wait(0.1)
    assert rig.server.body.position == (0.0,)


def test_fingers_without_a_part_close() -> None:
    rig = fingers("empty")
    rig.ask(Grip(position=0.0))
    rig.wait(3)
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.SUCCEEDED)]


def test_one_that_vanishes_is_started_anew_and_knows_of_no_goal() -> None:
    faults = Faults(trajectory.FAULTS)
    rig = arm(faults)
    rig.ask(AWAY)
    faults.switch("vanish", on=True)
    rig.said.clear()
    rig.wait(5)
    assert rig.said == []
    faults.switch("vanish", on=False)
    rig.wait(5)
    assert rig.of(Measurement) and not rig.of(GoalResult)


def base(*faults: str) -> Rig:
    on = Faults(nav2.FAULTS, faults)
    return Rig(VirtualServer(BaseBody(on, start=Pose(1.0, 1.0), speed=1.0), on))


def test_a_base_drives_from_pose_to_pose_and_its_odometry_begins_where_it_began() -> None:
    rig = base()
    rig.ask(Drive(frame="map", poses=(Pose(2.0, 1.0), Pose(2.0, 2.0, 1.5))))
    rig.wait(1.9)
    assert rig.server.body.position == pytest.approx((2.0, 1.0, 0.0), abs=1e-3)
    rig.wait(2.1)
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.SUCCEEDED)]
    last = rig.of(OdometryPose)[-1]
    assert isinstance(last, OdometryPose) and last.pose == Pose(1.0, 1.0, 1.5)
    assert 5 < len(rig.of(MapPose)) < 15, "localisation speaks where it has gone some way"


@pytest.mark.parametrize("frame", ["odom", "nowhere"])
def test_poses_of_another_frame_are_refused(frame: str) -> None:
    rig = base()
    rig.ask(Drive(frame=frame, poses=(Pose(2.0, 1.0),)))
    assert rig.of(GoalAnswer) == [GoalAnswer(id="1", accepted=False)]


def test_a_missed_waypoint_is_named_in_a_success() -> None:
    rig = base("missed")
    rig.ask(Drive(frame="map", poses=(Pose(2.0, 1.0), Pose(1.0, 1.5))))
    rig.wait(4)
    assert rig.of(GoalResult) == [GoalResult(id="1", status=Status.SUCCEEDED, missed=(0,))]


@pytest.mark.parametrize("known", [trajectory.FAULTS, gripper.FAULTS, nav2.FAULTS])
def test_there_are_at_least_ten_faults_each_with_a_sentence(known: dict[str, str]) -> None:
    assert len(known) >= 10 and all(known.values())


def test_what_it_needs_is_one_sentence_with_the_line_that_installs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "arboleda_ros.link", None)
    arm = controller(
        Faults(trajectory.FAULTS, ()), action="move", joint_states="j", joints=("a",), rate=50.0, lan=False
    )
    with pytest.raises(StartError, match=r"the virtual arm needs ROS 2, .*pip install 'arboleda\[ros\]'"):
        arm.start()
