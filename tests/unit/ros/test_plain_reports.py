"""Reports of a robot on ROS 2 that has no `status`, from its plain topics."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, UInt8

from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState, Report
from arboleda.testing import shipped
from arboleda_ros.plain_reports import PlainReports

PLANT = shipped("sis_a")
ARM, MOBILE = PLANT.robots["ra1"], PLANT.robots["rm_sis_a"]
NAMES = [*ARM.joint_states.joints]
Q = (0.5, -0.25, 0.0625)


@pytest.mark.parametrize("state", MotionState, ids=lambda state: state.name)
def test_each_state_is_a_report_of_its_own_time(state: MotionState) -> None:
    reports = PlainReports(ARM)
    for at in (1.0, 2.5):
        assert reports.state(at, UInt8(data=int(state))) == Report(at=at, robot="ra1", state=state)


def test_a_state_that_means_nothing_is_refused_with_those_that_mean_something() -> None:
    with pytest.raises(PayloadError, match=r"^the value 7 means nothing; allowed: 0, 1, "):
        PlainReports(ARM).state(1.0, UInt8(data=7))


def test_joints_are_read_by_their_names_whether_they_move_or_repeat() -> None:
    reports = PlainReports(ARM)
    backwards = JointState(name=["gripper", *reversed(NAMES)], position=[9.0, *reversed(Q)])
    for at, q in ((1.0, Q), (1.1, Q), (1.2, (0.0, 0.0, 0.0)), (1.3, Q)):
        message = backwards if q == Q else JointState(name=NAMES, position=list(q))
        report = reports.joints(at, message)
        assert report == Report(at=at, robot="ra1", q=q)
        assert report.words == Report(at=at, robot="ra1", q=q).words


def test_a_mobile_between_two_nodes_reports_no_node() -> None:
    reports, names = PlainReports(MOBILE), [*MOBILE.joint_states.joints]
    x, y = MOBILE.grid.position(1)
    half = MOBILE.grid.pitch / 2
    for at, place, node in ((1.0, [x, y], 1), (1.1, [x + half, y + half], None), (1.2, [x, y], 1)):
        found = reports.joints(at, JointState(name=names, position=place))
        assert found == Report(at=at, robot="rm_sis_a", node=node)


@pytest.mark.parametrize(
    ("message", "why"),
    [
        (JointState(name=NAMES, position=[0.5]), "3 joint names but 1 position"),
        (JointState(name=NAMES[:2], position=[0.5, 0.5]), f"joint {NAMES[2]} is missing; needed are "),
        (JointState(name=NAMES, position=[0.5, math.nan, 0.5]), "is not a finite number"),
    ],
)
def test_joints_that_mean_nothing_are_refused_and_change_nothing(message: JointState, why: str) -> None:
    reports = PlainReports(ARM)
    reports.joints(1.0, JointState(name=NAMES, position=list(Q)))
    with pytest.raises(PayloadError, match=why):
        reports.joints(1.1, message)
    assert reports.joints(1.2, JointState(name=NAMES, position=list(Q))) == Report(at=1.2, robot="ra1", q=Q)


def test_a_piece_is_reported_alone() -> None:
    for piece in (True, False):
        found = PlainReports(ARM).piece(1.0, Bool(data=piece))
        assert found == Report(at=1.0, robot="ra1", piece=piece)
