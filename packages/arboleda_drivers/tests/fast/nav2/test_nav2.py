"""The drivers for Nav2 without ROS 2: a test plays the action server, odometry and localisation."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from arboleda.drivers import FollowPath, Home, MotionState, MoveJoints, Report, Stop, StopMode
from arboleda.kinds.floor import Placement
from arboleda.kinds.mobile import Grid, Mobile
from arboleda.model.plant_model import Evidence, Link
from arboleda_drivers.connections.link import CommandNotSent
from arboleda_drivers.nav2.localisation import MapPose, OdometryPose
from arboleda_drivers.nav2.machine import Route, to_pose, waypoints
from arboleda_drivers.nav2.pose import Pose
from arboleda_drivers.nav2.settings import ToPose, Waypoints
from arboleda_drivers.ros_action.events import (
    CancelAll,
    CancelAnswer,
    GoalAnswer,
    GoalResult,
    SendGoal,
    ServersFound,
    Status,
)
from arboleda_drivers.ros_action.machine import Machine

from ..ros_action.action_rig import ActionRig

GRID = Grid(origin=Placement(x=2.0, y=1.0), pitch=1.0)
CART = Mobile(
    name="cart",
    mqtt="cart",
    link=Link.DRIVER,
    evidence=Evidence.IDS,
    timeout_s=30.0,
    model="cart",
    grid=GRID,
    speed=1.0,
)
WAY = FollowPath(id="9-1", robot="cart", nodes=(0, 1, 4))
HALT = Stop(id="9-9", robot="cart", mode=StopMode.HALT)
BEGAN = Pose(-5.0, 3.0, 0.7)  # of the base, by its odometry, where it stands on node 0
SETTINGS = ToPose(floor_m=(10.0, 0.0), floor_yaw_deg=90.0)


def on_map(node: float) -> Pose:
    """The pose of a node: the floor lies turned by a quarter at (10, 0)."""
    row, column = divmod(node, 3)
    return Pose(10.0 - (1.0 + row), 2.0 + column)


class Rig(ActionRig):
    """A base, whose odometry is seen while it counts."""

    def __init__(self, machine: Machine | None = None) -> None:
        super().__init__(machine or to_pose([CART], SETTINGS))
        self.at, self.counts = on_map(0), True
        self.odom_of_map = BEGAN @ on_map(0).inverse
        self.wait(0.2)
        self.localise()
        self.wait(0.5)

    def measure(self) -> None:
        if self.counts:
            self.tell(OdometryPose(stamp=self.stamp, pose=self.odom_of_map @ self.at))

    @property
    def stamp(self) -> tuple[int, int]:
        return (int(self.now), int(self.now % 1 * 1e9))

    def localise(self) -> None:
        self.tell(MapPose(stamp=self.stamp, pose=self.at))

    def sent(self) -> list[SendGoal]:
        return [each for each in self.said if isinstance(each, SendGoal)]

    def drives(self, node: float, status: Status = Status.SUCCEEDED) -> None:
        """The server has accepted the last goal, drives there, and ends it."""
        id = self.sent()[-1].id
        self.tell(GoalAnswer(id=id, accepted=True))
        self.at = on_map(node)
        self.wait(0.1)
        self.localise()
        self.tell(GoalResult(id=id, status=status))
        self.wait(0.1)


@pytest.fixture
def rig() -> Rig:
    return Rig()


def test_a_pose_is_seen_from_another_and_back() -> None:
    here, there = Pose(1.0, 2.0, 0.5), Pose(-3.0, 0.2, 3.0)
    back = here.inverse @ (here @ there)
    assert (back.x, back.y, back.yaw) == pytest.approx((there.x, there.y, there.yaw))


def test_it_stands_on_the_node_that_localisation_and_odometry_say(rig: Rig) -> None:
    assert (rig.last.node, rig.last.state) == (0, MotionState.STOPPED)
    rig.at = on_map(1)  # localisation says nothing: odometry has counted it
    rig.wait(0.6)
    assert rig.last.node == 1


def test_each_node_of_a_way_is_a_goal_in_the_direction_of_driving(rig: Rig) -> None:
    rig.ask(WAY)
    rig.drives(1)
    rig.drives(4)
    goals: list[Route] = [each.goal for each in rig.sent()]
    assert [goal.nodes for goal in goals] == [(1,), (4,)]
    assert [each.id for each in rig.sent()] == ["9-1", "9-1.1"]
    (pose,) = goals[0].poses
    assert (pose.x, pose.y) == pytest.approx((on_map(1).x, on_map(1).y))
    assert pose.yaw == pytest.approx(math.pi / 2)
    assert (rig.last.done, rig.last.node) == (WAY.id, 4)


def test_it_is_not_done_before_its_last_node(rig: Rig) -> None:
    rig.ask(WAY)
    rig.drives(1)
    assert rig.last.done is None and rig.last.state is MotionState.MOVING and rig.last.node == 1


def test_a_success_beside_the_node_is_none(rig: Rig) -> None:
    rig.ask(WAY)
    rig.drives(0.5)
    rig.wait(0.5)
    assert (rig.last.failed, rig.last.failure) == (WAY.id, "stands_on_no_node")
    assert len(rig.sent()) == 1


def test_a_success_on_another_node_is_compared_by_the_plant(rig: Rig) -> None:
    rig.ask(WAY)
    rig.drives(0)
    rig.wait(0.5)
    assert (rig.last.done, rig.last.node) == (WAY.id, 0)
    assert len(rig.sent()) == 1


def test_a_base_that_drives_on_after_its_success_is_moving(rig: Rig) -> None:
    rig.ask(FollowPath(id="9-2", robot="cart", nodes=(1,)))
    rig.tell(GoalAnswer(id="9-2", accepted=True), GoalResult(id="9-2", status=Status.SUCCEEDED))
    for step in range(9):
        rig.at = on_map(step / 10)
        rig.wait(0.1)
        assert rig.last.done is None and rig.last.state is MotionState.MOVING


def test_a_way_that_is_halted_between_two_nodes_goes_no_further(rig: Rig) -> None:
    rig.ask(WAY)
    rig.tell(GoalAnswer(id=WAY.id, accepted=True))
    assert CancelAll() in rig.ask(HALT)
    rig.tell(CancelAnswer(refused=False), GoalResult(id=WAY.id, status=Status.CANCELED))
    rig.wait(1)
    assert len(rig.sent()) == 1 and rig.last.state is MotionState.STOPPED


def test_waypoints_are_one_goal_and_a_missed_one_is_a_failure() -> None:
    rig = Rig(waypoints([CART], Waypoints(floor_m=(10.0, 0.0), floor_yaw_deg=90.0)))
    rig.ask(WAY)
    goal: Route = rig.sent()[0].goal
    assert goal.nodes == (1, 4) and len(goal.poses) == 2
    rig.tell(GoalAnswer(id=WAY.id, accepted=True))
    rig.at = on_map(4)
    rig.tell(GoalResult(id=WAY.id, status=Status.SUCCEEDED, missed=(0,)))
    assert (rig.last.failed, rig.last.failure) == (WAY.id, "missed_waypoints node 1")


def test_an_error_of_nav2_is_said_with_its_text(rig: Rig) -> None:
    rig.ask(WAY)
    id = rig.sent()[-1].id
    rig.tell(GoalResult(id=id, status=Status.ABORTED, error=208, text="no valid path"))
    assert rig.last.failure == "error 208 no valid path"


def test_without_localisation_it_is_nowhere() -> None:
    machine = to_pose([CART], SETTINGS)
    said = machine.step(100.0, [ServersFound(servers=(7,)), OdometryPose(stamp=(1, 0), pose=BEGAN)])
    lost = [each.lost for each in said if isinstance(each, Report)]
    assert "amcl_pose has not said yet where the base is" in str(lost[0])


def test_localisation_that_was_there_before_counts_from_the_first_odometry() -> None:
    machine = to_pose([CART], SETTINGS)
    early = MapPose(stamp=(50, 0), pose=on_map(4))
    found = ServersFound(servers=(7,))
    machine.step(100.0, [found, early, OdometryPose(stamp=(99, 0), pose=BEGAN)])
    said = machine.step(100.4, [found, OdometryPose(stamp=(99, 4), pose=BEGAN)])
    assert [each.node for each in said if isinstance(each, Report)] == [4]


def test_localisation_of_a_time_without_odometry_counts_for_nothing(rig: Rig) -> None:
    rig.at, rig.counts = on_map(1), False
    rig.now += 0.9
    rig.localise()  # odometry last spoke on node 0
    rig.counts = True
    rig.wait(0.6)
    assert rig.last.node == 1


def test_too_far_without_a_word_of_localisation_is_lost(rig: Rig) -> None:
    for step in range(25):
        rig.at = replace(on_map(0), x=9.0 - step / 10)
        rig.wait(0.1)
    assert "amcl_pose has said nothing new over 2 m of way" in str(rig.last.lost)
    assert isinstance(rig.ask(WAY)[0], CommandNotSent)
    rig.localise()
    rig.wait(0.1)
    assert rig.last.state is not MotionState.NO_LINK


def test_odometry_that_is_silent_or_repeats_itself_is_lost(rig: Rig) -> None:
    rig.counts = False
    same = OdometryPose(stamp=rig.stamp, pose=BEGAN)
    for _ in range(12):
        rig.wait(0.1)
        rig.tell(same)
    assert "odom has said nothing new for 1 s" in str(rig.last.lost)


@pytest.mark.parametrize("pose", [Pose(math.nan, 0), Pose(0, math.inf), Pose(0, 0, math.nan)])
def test_a_pose_that_is_none_is_passed_over(rig: Rig, pose: Pose) -> None:
    rig.tell(MapPose(stamp=rig.stamp, pose=pose), OdometryPose(stamp=(1, 1), pose=pose))
    rig.wait(0.2)
    assert rig.last.node == 0


def test_home_is_done_once_it_is_localised(rig: Rig) -> None:
    rig.ask(Home(id="9-5", robot="cart"))
    assert rig.last.homed is False
    rig.wait(0.1)
    assert (rig.last.done, rig.last.homed) == ("9-5", True)


def test_joints_are_none_of_its_words(rig: Rig) -> None:
    said = rig.ask(MoveJoints(id="9-6", robot="cart", q=(0.0,)))
    assert "no word for MoveJoints" in next(each.why for each in said if isinstance(each, CommandNotSent))


def test_settings_that_do_not_fit_are_said() -> None:
    assert [said for _, said in ToPose(tolerance_m=0.6).problems(CART)] == [
        "0.6 m is not less than half of the way to the next node, 0.5 m"
    ]
    with pytest.raises(ValueError, match="tolerance_m is 0"):
        ToPose(tolerance_m=0.0)
