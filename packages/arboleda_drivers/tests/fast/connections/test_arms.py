"""Reports of an arm behind TCP to the plant, whoever made it; with time moved by hand."""

from __future__ import annotations

import pytest

from arboleda.drivers import MotionState

from .arms import CLEAR, GO, GOAL, GRIP, HALT, LATCH, READY, RIGS, Rig

EACH = pytest.mark.parametrize("maker", RIGS)


def up(maker: str, *faults: str) -> Rig:
    joined = RIGS[maker](*faults)
    joined.wait(0.5)
    return joined


def moving(maker: str, *faults: str) -> Rig:
    """An arm that is on its way, before half of it."""
    joined = up(maker, *faults)
    assert joined.ask(GO) is None
    joined.wait(0.2)
    return joined


@EACH
def test_a_move_is_accepted_and_done_at_its_goal(maker: str) -> None:
    joined = moving(maker)
    assert (joined.last.accepted, joined.last.state) == (GO.id, MotionState.MOVING)
    joined.wait(3.0, until=lambda report: report.done is not None)
    end = joined.last
    assert (end.done, end.state, end.q) == (GO.id, MotionState.STOPPED, pytest.approx(GOAL, abs=1e-5))
    assert len(joined.told) == 1


@EACH
def test_a_report_comes_ten_times_a_second(maker: str) -> None:
    joined = up(maker)
    joined.reports.clear()
    joined.wait(1.0)
    assert 8 <= len(joined.reports) <= 12


@EACH
def test_an_arm_that_is_called_there_and_is_elsewhere_is_said_to_be_elsewhere(maker: str) -> None:
    joined = up(maker, "lie")
    joined.ask(GO)
    joined.wait(1.0)
    assert (joined.last.done, joined.last.q) == (GO.id, (0.0,) * 6)  # the plant compares


@pytest.mark.parametrize(
    ("maker", "fault", "after_s", "word"),
    [
        ("dobot", "refuse", 0.1, "not_executed"),
        ("dobot", "script", 0.1, "script_running"),
        ("dobot", "not_tcp", 0.1, "not_in_tcp_mode"),
        ("dobot", "power_off", 0.1, "power_off"),
        ("dobot", "stop_button", 0.1, "robot_stop_button"),
        ("ur", "refuse", 2.5, "program_refused line 1: refused"),
        ("ur", "not_begun", 2.5, "not_begun"),
        ("ur", "popup", 2.5, "not_begun"),
        ("ur", "echo_lost", 2.5, "not_begun"),
        ("ur", "local_control", 2.5, "local_control"),
    ],
)
def test_a_refusal_has_the_reason_of_the_controller(
    maker: str, fault: str, after_s: float, word: str
) -> None:
    joined = up(maker, fault)
    joined.ask(GO)
    joined.wait(after_s)
    assert (joined.last.rejected, joined.last.refusal, joined.last.done) == (GO.id, word, None)


@pytest.mark.parametrize(
    ("maker", "fault", "words"),
    [
        ("dobot", "collision", "collision"),
        ("dobot", "alarm", "alarm 17: no joints reach that pose"),
        ("dobot", "stop_button", "alarm 116: the stop button at the robot is pressed"),
        ("dobot", "power_off", "power_off"),
        ("dobot", "second_client", "another_client_moves_it"),
        ("ur", "protective_stop", "protective_stop"),
        ("ur", "safeguard", "safeguard_stop"),
        ("ur", "stop_button", "robot_stop_button"),
        ("ur", "power_off", "power_off"),
        ("ur", "brakes_stuck", "brakes_not_released"),
        ("ur", "program_stopped", "program_stopped"),
        ("ur", "joint_limit", "program_stopped line 4: joint limit"),
        ("ur", "local_control", "program_stopped"),
        ("ur", "heartbeat_lost", "program_stopped"),
        ("ur", "other_program", "program_stopped"),
    ],
)
def test_a_move_that_breaks_off_fails_with_the_reason(maker: str, fault: str, words: str) -> None:
    joined = moving(maker, *(["slow"] if fault == "heartbeat_lost" else []))
    joined.faults.switch(fault, on=True)
    joined.wait(1.0 if maker == "dobot" else 3.0)
    assert (joined.last.failed, joined.last.failure, joined.last.done) == (GO.id, words, None)


@pytest.mark.parametrize(
    ("maker", "fault", "why"),
    [
        *(("dobot", fault, "") for fault in ("mute", "frozen", "garbled", "no_replies", "hang_up")),
        *(("dobot", fault, "") for fault in ("nonsense_replies", "power_cycle")),
        ("ur", "mute", "stood still"),
        ("ur", "frozen", "stood still"),
        ("ur", "garbled", "stood still"),
        ("ur", "torn", "a packet of type"),
        ("ur", "dashboard_mute", "has not answered is in remote control for 2 s"),
        ("ur", "unasked_replies", "nobody asked"),
        ("ur", "old_rtde", "does not speak version 2"),
        ("ur", "in_use", "another client of RTDE writes input_int_register_24"),
        ("ur", "connections_full", "refused"),
        ("ur", "reboot", "refused"),
    ],
)
def test_a_controller_that_does_not_make_sense_has_no_link(maker: str, fault: str, why: str) -> None:
    joined = up(maker)
    joined.faults.switch(fault, on=True)
    joined.ask(GO)
    joined.wait(4.0)
    lost = [each for each in joined.reports if each.state is MotionState.NO_LINK]
    assert any(each.lost and why in str(each.lost) for each in lost)
    if fault != "dashboard_mute":  # which the end of a move does not need
        assert all(each.done is None for each in joined.reports)


@pytest.mark.parametrize(
    ("maker", "fault"),
    [
        ("dobot", "torn"),
        ("dobot", "late_replies"),
        ("ur", "late_start"),
        ("ur", "late_runtime"),
        ("ur", "slow"),
        ("ur", "late_replies"),
        ("ur", "rate_drops"),
    ],
)
def test_what_is_late_or_torn_is_waited_for(maker: str, fault: str) -> None:
    joined = up(maker, fault)
    joined.ask(GO)
    joined.wait(8.0, until=lambda report: report.done is not None)
    assert (joined.last.done, joined.last.q) == (GO.id, pytest.approx(GOAL, abs=1e-5))


@EACH
def test_what_was_left_at_work_is_stopped_by_who_comes_back(maker: str) -> None:
    joined = moving(maker)
    joined.faults.switch("mute", on=True)
    joined.wait(1.2)
    joined.faults.switch("mute", on=False)
    before = len(joined.told)
    joined.wait(2.0)
    assert [joined.stop_line in each for each in joined.told[before:]] == [True]
    assert (joined.last.state, joined.last.done) == (MotionState.STOPPED, None)


@EACH
def test_a_halt_ends_the_move_and_is_still_only_once_it_stands(maker: str) -> None:
    joined = moving(maker)
    joined.ask(HALT)
    joined.reports.clear()
    joined.wait(2.0, until=lambda report: report.state is MotionState.STOPPED)
    rest = joined.last.q
    assert rest is not None and 0 < rest[0] < GOAL[0]
    joined.wait(1.0)
    assert (joined.last.q, joined.last.done, joined.last.accepted) == (rest, None, HALT.id)


@EACH
def test_a_latch_is_said_until_it_is_cleared(maker: str) -> None:
    joined = up(maker)
    joined.ask(LATCH)
    joined.wait(1.0)
    assert joined.last.state is MotionState.STOP_LATCHED
    joined.ask(CLEAR)
    joined.wait(0.2)
    assert joined.last.state is MotionState.STOPPED


@EACH
def test_a_grip_is_accepted_once_its_output_is_read_back(maker: str) -> None:
    joined = up(maker)
    assert joined.last.effector is False
    joined.reports.clear()
    joined.ask(GRIP)
    joined.wait(0.2)
    assert (joined.last.accepted, joined.last.effector) == (GRIP.id, True)
    assert all(report.effector for report in joined.reports if report.accepted == GRIP.id)


@EACH
def test_an_output_that_does_not_follow_is_a_failure(maker: str) -> None:
    joined = up(maker, "stuck_output")
    joined.ask(GRIP)
    joined.wait(2.0)
    assert (joined.last.accepted, joined.last.effector) == (None, False)
    assert (joined.last.failed, joined.last.failure) == (GRIP.id, "output_does_not_follow")


@pytest.mark.parametrize(("maker", "fault", "off_s"), [("dobot", "power_cycle", 5.0), ("ur", "reboot", 20.0)])
def test_a_boot_has_another_number_and_forgets_what_was_open(maker: str, fault: str, off_s: float) -> None:
    joined = moving(maker)
    before = joined.last.boot_id
    joined.faults.switch(fault, on=True)
    joined.wait(off_s)
    joined.faults.switch(fault, on=False)
    joined.wait(2.0)
    assert joined.last.boot_id != before
    assert (joined.last.state, joined.last.accepted, joined.last.done) == (MotionState.NOT_HOMED, None, None)


@pytest.mark.parametrize(("maker", "fault"), [("dobot", "power_cycle"), ("ur", "connections_full")])
def test_nothing_leaves_without_a_connection(maker: str, fault: str) -> None:
    joined = RIGS[maker](fault)
    joined.wait(0.1)
    assert joined.ask(GO) == f"{maker} is not connected"


@EACH
def test_another_command_is_refused_while_it_is_at_work(maker: str) -> None:
    joined = moving(maker)
    joined.ask(READY)
    joined.wait(0.1)
    assert (joined.last.rejected, joined.last.refusal) == (READY.id, "busy")
