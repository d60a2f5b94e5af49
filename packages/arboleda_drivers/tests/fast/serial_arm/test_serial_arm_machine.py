"""The driver of an arm of servos, against virtual servos of both makers, under a clock moved by hand."""

from __future__ import annotations

import math

import pytest

from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState, Report
from arboleda_drivers.serial_arm.settings import ServoJoint
from arboleda_lines.line import Form

from .serial_arm_rig import SETTINGS, STILL, ServoRig

MAKERS = pytest.mark.parametrize("maker", ["feetech", "dynamixel"])
LEFT = (-40.0, 30.0, 20.0, 30.0, 0.0)


def degrees(report: Report) -> tuple[float, ...]:
    assert report.q is not None
    return tuple(round(math.degrees(each), 1) for each in report.q)


@MAKERS
def test_a_move_is_accepted_by_its_goals_and_done_by_its_positions(maker: str) -> None:
    rig = ServoRig(maker)
    id = rig.move(*LEFT)
    accepted = rig.until(accepted=id)
    assert accepted.state is MotionState.MOVING and accepted.done is None
    done = rig.until(done=id)
    assert done.state is STILL
    assert degrees(done) == pytest.approx(LEFT, abs=0.2)
    third = rig.servos.servos[3]
    assert third.at < 2048  # its direction is reversed


@MAKERS
def test_all_joints_arrive_together(maker: str) -> None:
    rig = ServoRig(maker)
    rig.move(60, 10, 0, 0, 0)
    rig.wait(0.6)
    first, second = degrees(rig.report)[:2]
    assert second / first == pytest.approx(1 / 6, rel=0.3)


@MAKERS
def test_an_arm_without_torque_is_made_ready_where_it_is(maker: str) -> None:
    rig = ServoRig(maker, torque=False)
    for servo in rig.servos.servos.values():
        servo.set_goal(3000)  # a goal of before: it must not go there
    assert rig.report.state is MotionState.NOT_HOMED and rig.report.homed is False
    assert ("torque", "off") in (rig.report.facts or ())
    before = dict(rig.servos.positions())
    id = rig.home()
    rig.until(done=id, state=STILL, homed=True)
    rig.wait(0.5)
    assert rig.servos.positions() == before


@MAKERS
def test_a_stop_holds_the_arm_where_it_is(maker: str) -> None:
    rig = ServoRig(maker)
    move = rig.move(*LEFT)
    rig.wait(0.5)
    id = rig.stop(StopMode.LATCH)
    rig.until(accepted=id)
    held = rig.until(state=MotionState.STOP_LATCHED)
    assert -39 < degrees(held)[0] < -5
    rig.wait(1.0)
    assert degrees(rig.report) == pytest.approx(degrees(held), abs=0.5)
    assert rig.report.done != move
    rig.stop(StopMode.CLEAR)
    rig.until(state=STILL)


def test_the_stop_is_the_next_thing_on_the_bus() -> None:
    rig = ServoRig()
    rig.move(*LEFT)
    rig.wait(0.5)
    written = len(rig.line.written)
    rig.stop()
    assert rig.line.written[written][4] == 0x83


def test_a_stop_that_is_not_taken_is_not_confirmed() -> None:
    rig = ServoRig()
    rig.move(100, 0, 0, 0, 0)
    rig.wait(0.3)
    rig.faults.switch("deaf", on=True)
    id = rig.stop()
    rig.wait(0.3)
    assert rig.report.accepted != id and rig.report.state is MotionState.MOVING


@MAKERS
def test_an_overload_stops_the_arm_and_home_leads_out(maker: str) -> None:
    rig = ServoRig(maker, "overload")
    rig.move(*LEFT)
    assert rig.told("failure") == "overload of shoulder_lift"
    rig.until(state=MotionState.FAULT)
    assert ("health", "overload") in (rig.report.facts or ())
    rig.faults.switch("overload", on=False)
    boot = rig.report.boot_id
    rig.until(done=rig.home(), state=STILL, homed=True, boot_id=boot)


def test_heat_and_voltage_are_facts() -> None:
    rig = ServoRig()
    assert {("celsius", 30), ("volts", 7.4)} <= set(rig.report.facts or ())
    rig.faults.switch("overheating", on=True)
    rig.until(state=MotionState.FAULT)
    assert {("celsius", 80), ("health", "overheating")} <= set(rig.report.facts or ())


@MAKERS
def test_a_servo_that_does_not_answer_has_the_others_hold(maker: str) -> None:
    rig = ServoRig(maker)
    rig.move(-100, 60, 40, 60, 0)
    rig.wait(0.3)
    rig.faults.switch("mute_servo", on=True)
    lost = rig.until(state=MotionState.NO_LINK)
    assert "servo 3 (elbow_flex) does not answer" in str(lost.lost)
    there = rig.servos.positions()[1]
    assert there > 2048 - 1100  # its goal is 1138 ticks away
    rig.wait(0.5)
    assert rig.servos.positions()[1] == pytest.approx(there, abs=90)
    rig.faults.switch("mute_servo", on=False)
    rig.until(state=STILL)


@MAKERS
def test_the_line_is_blamed_where_no_servo_answers(maker: str) -> None:
    rig = ServoRig(maker)
    rig.faults.switch("mute", on=True)
    lost = rig.until(state=MotionState.NO_LINK)
    assert str(lost.lost).endswith(": no servo answers; is the arm powered, and the baud rate right?")


@MAKERS
def test_a_process_that_stood_still_takes_no_servo_for_silent(maker: str) -> None:
    rig = ServoRig(maker)
    before = len(rig.reports)
    rig.line.pass_time(rig.line.now + 0.6)
    rig.wait(0.3)
    assert {report.state for report in rig.reports[before:]} == {STILL}


@MAKERS
def test_power_that_is_lost_is_a_boot(maker: str) -> None:
    rig = ServoRig(maker)
    rig.until(done=rig.move(10, 0, 0, 0, 0))
    boot = rig.report.boot_id
    rig.move(*LEFT)
    rig.wait(0.3)
    rig.faults.switch("power_cycle", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.faults.switch("power_cycle", on=False)
    back = rig.until(state=MotionState.NOT_HOMED)
    assert back.boot_id != boot
    there = rig.servos.positions()
    rig.wait(1.0)
    assert rig.servos.positions() == there
    rig.until(done=rig.home(), state=STILL)


def test_a_cable_that_is_pulled_and_put_back() -> None:
    rig = ServoRig()
    rig.move(*LEFT)
    rig.wait(0.4)
    rig.faults.switch("unplugged", on=True)
    rig.until(state=MotionState.NO_LINK)
    rig.faults.switch("unplugged", on=False)
    rig.until(state=STILL)
    there = rig.servos.positions()
    rig.wait(0.5)
    assert rig.servos.positions() == there


@pytest.mark.sampled(3)
@pytest.mark.parametrize("fault", ["broken_frames", "torn", "noise", "echo", "wrong_id", "late"])
@MAKERS
def test_a_bad_line_never_proves_anything(maker: str, fault: str) -> None:
    rig = ServoRig(maker)
    rig.faults.switch(fault, on=True)
    id = rig.move(*LEFT)
    rig.wait(4.0)
    if rig.report.done == id:
        assert degrees(rig.report) == pytest.approx(LEFT, abs=2)
    else:
        assert fault not in ("noise", "echo")
    rig.faults.switch(fault, on=False)
    rig.until(state=STILL)


def test_a_goal_that_a_servo_does_not_take_is_refused() -> None:
    rig = ServoRig("feetech", "no_goal")
    rig.move(*LEFT)
    assert rig.told("refusal") == "goal_not_taken by shoulder_lift"
    there = rig.until(state=STILL)
    assert degrees(there)[0] > -25


def test_another_program_that_moves_a_servo_is_noticed() -> None:
    rig = ServoRig("feetech", "another_master")
    rig.move(*LEFT)
    assert rig.told("failure") == "another_goal of shoulder_pan"


def test_an_arm_that_does_not_get_there_ends_where_it_stands() -> None:
    """The plant finds it there: the move has failed."""
    rig = ServoRig("feetech", "pushed")
    id = rig.move(*LEFT)
    end = rig.until(done=id)
    assert abs(degrees(end)[0] - LEFT[0]) > 10


@MAKERS
def test_a_joint_that_stands_still_while_it_should_move_is_a_fault_and_home_leads_out(maker: str) -> None:
    rig = ServoRig(maker, "stall")
    rig.move(*LEFT)
    assert rig.told("failure") == "stands_still of shoulder_pan"
    rig.until(state=MotionState.FAULT)
    assert ("health", "stands_still") in (rig.report.facts or ())
    rig.until(done=rig.home(), state=STILL, homed=True)
    assert rig.servos.servos[1].goal == pytest.approx(rig.servos.servos[1].at, abs=1), "it presses no more"


def third_goes_far(maker: str) -> ServoRig:
    """A rig whose third joint repeats its position from the middle of a way of 80 degrees on."""
    rig = ServoRig(maker)
    rig.move(0, 0, 80, 0, 0)
    rig.wait(0.6)
    rig.faults.switch("old_position", on=True)
    return rig


@MAKERS
def test_a_position_that_is_repeated_under_way_is_a_fault_within_half_a_second(maker: str) -> None:
    rig = third_goes_far(maker)
    rig.wait(0.5)
    assert rig.report.failure == "stands_still of elbow_flex"
    assert rig.report.state is MotionState.FAULT


@MAKERS
@pytest.mark.parametrize("after_s", [0.15, 0.25, 1.2])
def test_a_stop_throws_no_joint_back_to_an_old_position(maker: str, after_s: float) -> None:
    rig = third_goes_far(maker)
    rig.wait(after_s)
    elbow = rig.servos.servos[3]
    there, way = elbow.at, math.copysign(1, elbow.goal - elbow.start)
    rig.stop()
    rig.wait(1.0)
    assert way * (elbow.at - there) > -40, "nor faster than it came"
    assert rig.report.state is not STILL
    rig.faults.switch("old_position", on=False)
    rig.until(state=STILL)
    assert elbow.goal == pytest.approx(elbow.at, abs=1)


@MAKERS
def test_a_stop_is_held_at_the_speed_of_the_move(maker: str) -> None:
    rig = ServoRig(maker)
    rig.move(*LEFT)
    rig.wait(0.6)
    first = rig.servos.servos[1]
    told = first.get(first.layout.speed)
    rig.stop()
    rig.wait(0.1)
    assert first.get(first.layout.speed) == told


@MAKERS
@pytest.mark.parametrize(("slow_s", "after_s"), [(0.1, 0.6), (0.15, 0.9), (0.18, 0.5)])
def test_a_stop_throws_no_joint_back_to_a_position_that_a_slow_line_told_long_ago(
    maker: str, slow_s: float, after_s: float
) -> None:
    rig = ServoRig(maker, reply_s=0.2)
    rig.move(0, 0, 80, 0, 0)
    rig.wait(0.3)
    rig.line.line.begin(Form(word="slow", delay_s=slow_s))
    rig.wait(after_s)
    elbow = rig.servos.servos[3]
    there, way = elbow.at, math.copysign(1, elbow.goal - elbow.start)
    rig.stop()
    for _ in range(10):
        rig.wait(0.1)
        assert way * (elbow.at - there) > -40
    rig.line.line.end()
    rig.until(state=STILL)
    assert elbow.goal == pytest.approx(elbow.at, abs=1)


@MAKERS
def test_an_answer_is_of_no_other_round_by_its_length(maker: str) -> None:
    rig = ServoRig(maker)
    rig.wait(0.2)
    written = len(rig.line.written)
    rig.wait(1.0)
    place = {"feetech": 2, "dynamixel": 4}[maker]
    of_first = [packet for packet in rig.line.written[written:] if packet[place] == 1]
    assert len(of_first) > 12
    assert all(len({*of_first[each : each + 8]}) == 8 for each in range(len(of_first) - 8))
    assert rig.report.state is STILL


def test_a_servo_that_is_silent_as_a_stop_comes_holds_once_it_is_heard() -> None:
    rig = ServoRig()
    rig.move(0, 0, 80, 0, 0)
    rig.wait(0.6)
    rig.faults.switch("mute_servo", on=True)
    rig.wait(0.2)
    elbow = rig.servos.servos[3]
    there = elbow.at
    rig.stop()
    rig.wait(0.1)
    rig.faults.switch("mute_servo", on=False)
    rig.until(state=STILL)
    assert elbow.at == pytest.approx(there, abs=60)


def test_a_hand_that_moves_an_arm_without_torque_is_seen() -> None:
    rig = ServoRig()
    rig.faults.switch("torque_off", on=True)
    rig.until(state=MotionState.NOT_HOMED)
    rig.servos.servos[1].at += 100
    rig.wait(0.3)
    assert degrees(rig.report)[0] == pytest.approx(8.8)
    rig.move(*LEFT)
    assert "torque_off" in rig.told("refusal")


def test_goals_beyond_the_limits_of_the_plant_file_are_refused() -> None:
    narrow = (ServoJoint(id=1, least=1900, most=2200), *SETTINGS.joints[1:])
    rig = ServoRig(joints=narrow)
    rig.move(*LEFT)
    assert rig.told("refusal") == "beyond_limits of shoulder_pan"


@MAKERS
def test_the_gripper_is_what_its_position_shows(maker: str) -> None:
    rig = ServoRig(maker)
    rig.grip(on=False)
    rig.until(effector=False)
    rig.grip(on=True)
    rig.until(effector=True)
    assert ("hand", "empty") in (rig.report.facts or ())
    rig.grip(on=False)
    rig.until(effector=False)
    rig.faults.switch("part", on=True)
    id = rig.grip(on=True)
    rig.until(accepted=id, effector=True)
    assert ("hand", "part") in (rig.report.facts or ())


def test_a_gripper_that_does_not_move_is_refused() -> None:
    rig = ServoRig("feetech")
    rig.grip(on=False)
    rig.until(effector=False)
    rig.faults.switch("gripper_stuck", on=True)
    rig.grip(on=True)
    assert rig.told("refusal") == "stands_still of gripper"


def test_a_stop_leaves_the_gripper_closed() -> None:
    rig = ServoRig("feetech", "part")
    rig.grip(on=False)
    rig.until(effector=False)
    rig.grip(on=True)
    rig.until(effector=True)
    rig.move(*LEFT)
    rig.wait(0.4)
    rig.until(accepted=rig.stop())
    rig.wait(1.0)
    assert rig.servos.servos[6].goal == 2000 and rig.report.effector is True


def test_a_servo_that_turns_without_end_is_no_joint() -> None:
    rig = ServoRig("feetech", "wrong_mode")
    assert "operating mode 1, which holds no position" in str(rig.report.lost)


def test_a_second_work_is_refused() -> None:
    rig = ServoRig()
    rig.move(*LEFT)
    rig.move(0, 0, 0, 0, 0)
    assert rig.told("refusal") == "busy"
