"""Messages that are made once and changed from report to report."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

from rclpy.clock import Clock
from rclpy.serialization import serialize_message

from arboleda.model.errors import PayloadError
from arboleda.model.messages import MotionState, Report
from arboleda.testing import shipped
from arboleda_ros import statuses
from arboleda_ros.robot_publisher import JointsMessage, StatusMessage

PLANT = shipped("sis_a")
ARM, MOBILE = PLANT.robots["ra1"], PLANT.robots["rm_sis_a"]
MOVING = Report(
    at=0.0, robot="ra1", epoch=9, boot_id=4, state=MotionState.MOVING, q=(0.1, -0.2, 0.03), piece=True
)
FURTHER = replace(MOVING, q=(0.2, -0.2, 0.03), accepted="7-2")
REFUSED = Report(at=0.0, robot="ra1", epoch=9, rejected="7-0", refusal="limite")
GONE = Report(at=0.0, robot="ra1", epoch=9, state=MotionState.NO_LINK, q=(0.2, -0.2, 0.03))
NUMBERED = replace(MOVING, number=41)
REPORTS = [MOVING, FURTHER, NUMBERED, REFUSED, GONE]


@pytest.mark.parametrize(("before", "report"), list(permutations(REPORTS, 2)))
def test_a_status_holds_nothing_of_the_report_before(before, report):
    status = StatusMessage(ARM)
    for each in (before, report, before):
        message = status.of(each)
        assert message == StatusMessage(ARM).of(each)
        assert statuses.report_of(0.0, ARM, message) == each


def test_a_report_that_repeats_the_last_has_the_same_status():
    status = StatusMessage(ARM)
    assert statuses.report_of(0.0, ARM, status.of(MOVING)) == MOVING
    assert statuses.report_of(0.0, ARM, status.of(MOVING.again(1.0))) == MOVING


def test_a_status_is_heard_as_the_report_it_was_made_of_again_and_again():
    said, heard, now = StatusMessage(ARM), [], [0.0]
    ear = statuses.StatusListener(ARM, lambda: now[0], heard.append)
    numbered = [replace(NUMBERED, number=number) for number in (9, 10, 4294967295)]
    reports = [MOVING, MOVING, FURTHER, MOVING, MOVING, GONE, *numbered, FURTHER]
    for number, report in enumerate(reports):
        now[0] = float(number)
        ear(serialize_message(said.of(report)))
        assert heard[-1] == replace(report, at=float(number))
    assert len(heard) == len(reports)


def test_a_status_that_says_the_same_under_the_next_number_is_not_read_again(monkeypatch):
    said, heard = StatusMessage(ARM), []
    ear = statuses.StatusListener(ARM, lambda: 0.0, heard.append)
    ear(serialize_message(said.of(NUMBERED)))
    monkeypatch.setattr(statuses, "deserialize_message", None)
    ear(serialize_message(said.of(NUMBERED.again(0.0, number=42))))
    assert heard == [NUMBERED, replace(NUMBERED, number=42)]


def test_a_number_that_no_board_can_tell_is_refused_also_where_nothing_else_changed():
    said, heard = StatusMessage(ARM), []
    ear = statuses.StatusListener(ARM, lambda: 0.0, heard.append)
    ear(serialize_message(said.of(NUMBERED)))
    with pytest.raises(PayloadError, match="number is '9999999999'; an integer of 0 to 4294967295 is needed"):
        ear(serialize_message(said.of(NUMBERED.again(0.0, number=9_999_999_999))))
    assert heard == [NUMBERED]


def test_a_bad_status_is_refused_each_time_it_comes():
    heard = []
    ear = statuses.StatusListener(ARM, lambda: 0.0, heard.append)
    good = serialize_message(StatusMessage(ARM).of(MOVING))
    bad = serialize_message(StatusMessage(MOBILE).of(MOVING))
    ear(good)
    for _ in range(2):
        with pytest.raises(PayloadError, match="status name"):
            ear(bad)
    ear(good)
    assert heard == [MOVING, MOVING]


def test_joints_are_those_of_the_last_report_and_stamped_anew():
    joints, clock = JointsMessage(ARM), Clock()
    first = joints.of(MOVING, clock)
    assert (list(first.name), list(first.position)) == (
        ["r1_brazo_joint", "r1_antebrazo_joint", "r1_efector_joint"],
        list(MOVING.q),
    )
    stamp = (first.header.stamp.sec, first.header.stamp.nanosec)
    second = joints.of(FURTHER, clock)
    assert list(second.position) == list(FURTHER.q)
    assert (second.header.stamp.sec, second.header.stamp.nanosec) > stamp


@pytest.mark.parametrize("report", [REFUSED, GONE], ids=["not measured", "nobody hears it"])
def test_joints_that_were_not_measured_make_no_message(report):
    joints = JointsMessage(ARM)
    joints.of(MOVING, Clock())
    assert joints.of(report, Clock()) is None


def test_a_mobile_stands_where_its_node_is():
    report = Report(at=0.0, robot="rm_sis_a", state=MotionState.STOPPED, node=4)
    message = JointsMessage(MOBILE).of(report, Clock())
    assert tuple(message.position) == MOBILE.grid.position(4)
