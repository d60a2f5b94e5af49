"""The driver of a Dobot against a virtual one, with time moved by hand: what the plant hears of it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.drivers import MotionState, Report, SetEffector, Stop, StopMode
from arboleda.model.commands import Home
from arboleda_drivers.connections.link import CommandRequest, Opened
from arboleda_drivers.dobot.frames import Feedback, Mode
from arboleda_drivers.dobot.machine import DashboardReply, FeedbackData, Machine
from arboleda_drivers.dobot.settings import Settings

from .dobot_rig import ARM, GO, GOAL, Loopback

HALT = Stop(id="9-5", robot=ARM.name, mode=StopMode.HALT)
LATCH = Stop(id="9-6", robot=ARM.name, mode=StopMode.LATCH)
CLEAR = Stop(id="9-7", robot=ARM.name, mode=StopMode.CLEAR)
READY = Home(id="9-2", robot=ARM.name)
GRIP = SetEffector(id="9-3", robot=ARM.name, on=True)
FRAME = Feedback(mode=Mode.IDLE, command=0, joints_deg=(0.0,) * 6, time_ms=1_700_000_000_000, run_ms=1000)


def up(*faults: str, enabled: bool = True) -> Loopback:
    joined = Loopback(*faults, enabled=enabled)
    joined.wait(0.5)
    return joined


def moving(*faults: str) -> Loopback:
    """An arm that is on its way, before half of it."""
    joined = up(*faults)
    assert joined.ask(GO) is None
    joined.wait(0.2)
    return joined


def test_a_move_is_accepted_and_done_at_its_goal() -> None:
    joined = moving()
    assert (joined.last.accepted, joined.last.state) == (GO.id, MotionState.MOVING)
    joined.wait(3.0, until=lambda report: report.done is not None)
    end = joined.last
    assert (end.done, end.state, end.q) == (GO.id, MotionState.STOPPED, pytest.approx(GOAL, abs=1e-5))
    assert sum(line.startswith("MovJ") for line in joined.received) == 1


def test_a_report_comes_ten_times_a_second() -> None:
    joined = up()
    joined.reports.clear()
    joined.wait(1.0)
    assert 8 <= len(joined.reports) <= 12


def test_an_arm_that_is_called_there_and_is_elsewhere_is_said_to_be_elsewhere() -> None:
    joined = up("lie")
    joined.ask(GO)
    joined.wait(1.0)
    assert (joined.last.done, joined.last.q) == (GO.id, (0.0,) * 6)  # the plant compares


@pytest.mark.parametrize(
    ("fault", "word"),
    [
        ("refuse", "not_executed"),
        ("script", "script_running"),
        ("not_tcp", "not_in_tcp_mode"),
        ("power_off", "power_off"),
        ("stop_button", "robot_stop_button"),
    ],
)
def test_a_refusal_has_the_reason_of_the_controller(fault: str, word: str) -> None:
    joined = up(fault)
    joined.ask(GO)
    joined.wait(0.1)
    assert joined.last.rejected == GO.id and joined.last.refusal == word


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("collision", "collision"),
        ("alarm", "alarm 17: no joints reach that pose"),
        ("stop_button", "alarm 116: the stop button at the robot is pressed"),
        ("power_off", "power_off"),
        ("second_client", "another_client_moves_it"),
    ],
)
def test_a_move_that_breaks_off_fails_with_the_reason(fault: str, words: str) -> None:
    joined = moving()
    joined.faults.switch(fault, on=True)
    joined.wait(1.0)
    assert (joined.last.failed, joined.last.failure) == (GO.id, words)
    assert joined.last.done is None


@pytest.mark.parametrize(
    "fault", ["mute", "frozen", "garbled", "no_replies", "nonsense_replies", "hang_up", "power_cycle"]
)
def test_a_controller_that_does_not_make_sense_has_no_link(fault: str) -> None:
    joined = up(fault)
    joined.ask(GO)
    joined.wait(2.5)
    assert any(report.state is MotionState.NO_LINK and report.lost for report in joined.reports)
    assert all(report.done is None for report in joined.reports)


def test_what_was_left_at_work_is_stopped_by_who_comes_back() -> None:
    joined = moving()
    joined.faults.switch("mute", on=True)
    joined.wait(1.2)
    joined.faults.switch("mute", on=False)
    joined.received.clear()
    joined.wait(2.0)
    assert "Stop()" in joined.received and not any(line.startswith("MovJ") for line in joined.received)
    assert (joined.last.state, joined.last.done) == (MotionState.STOPPED, None)


def test_a_halt_ends_the_move_and_is_still_only_once_it_stands() -> None:
    joined = moving()
    joined.ask(HALT)
    joined.reports.clear()
    joined.wait(2.0, until=lambda report: report.state is MotionState.STOPPED)
    rest = joined.last.q
    assert rest is not None and 0 < rest[0] < GOAL[0]
    joined.wait(1.0)
    assert (joined.last.q, joined.last.done, joined.last.accepted) == (rest, None, HALT.id)


def test_a_latch_is_said_until_it_is_cleared() -> None:
    joined = up()
    joined.ask(LATCH)
    joined.wait(1.0)
    assert joined.last.state is MotionState.STOP_LATCHED
    joined.ask(CLEAR)
    joined.wait(0.2)
    assert joined.last.state is MotionState.STOPPED


def test_clearing_clears_the_alarms_of_the_controller() -> None:
    joined = moving()
    joined.faults.switch("alarm", on=True)
    joined.wait(1.0)
    joined.faults.switch("alarm", on=False)
    joined.ask(CLEAR)
    joined.wait(0.5)
    assert joined.last.state is MotionState.STOPPED


def test_an_alarm_is_a_fact_and_a_stop_beside_it_shows_first_so_that_it_can_be_cleared() -> None:
    joined = moving()
    joined.faults.switch("alarm", on=True)
    joined.wait(1.0)
    assert (joined.last.state, joined.last.fact("health")) == (MotionState.FAULT, "alarm")
    joined.ask(LATCH)
    joined.wait(1.0)
    assert (joined.last.state, joined.last.fact("health")) == (MotionState.STOP_LATCHED, "alarm")
    joined.faults.switch("alarm", on=False)
    joined.ask(CLEAR)
    joined.wait(0.5)
    assert (joined.last.state, joined.last.fact("health")) == (MotionState.STOPPED, "ok")


def test_getting_ready_powers_and_enables_the_arm() -> None:
    joined = Loopback("power_off", enabled=False)
    joined.wait(0.5)
    assert (joined.last.state, joined.last.homed) == (MotionState.NOT_HOMED, False)
    joined.faults.switch("power_off", on=False)
    joined.ask(READY)
    joined.wait(5.0, until=lambda report: report.done == READY.id)
    assert (joined.last.state, joined.last.homed) == (MotionState.STOPPED, True)
    assert [line for line in joined.received if line in ("PowerOn()", "EnableRobot()")] == [
        "PowerOn()",
        "EnableRobot()",
    ]


@pytest.mark.parametrize("fault", [None, "collision", "alarm"])
def test_getting_ready_shows_as_unready_and_then_ready_whatever_was_missing(fault: str | None) -> None:
    joined = moving(*([fault] if fault else []))
    joined.wait(3.0)
    if fault:
        joined.faults.switch(fault, on=False)
    joined.reports.clear()
    joined.ask(READY)
    joined.wait(3.0, until=lambda report: report.done == READY.id)
    seen = [(report.homed, report.done == READY.id) for report in joined.reports]
    assert seen[0] == (False, False) and seen[-1] == (True, True)
    assert all(report.state is not MotionState.FAULT for report in joined.reports)


def test_an_arm_whose_button_stays_pressed_does_not_get_ready() -> None:
    joined = up("stop_button")
    joined.ask(READY)
    joined.wait(20.0)
    assert (joined.last.failed, joined.last.done) == (READY.id, None)


def test_the_effector_is_the_output_that_the_controller_reads_back() -> None:
    joined = up()
    joined.ask(GRIP)
    joined.wait(0.1)
    assert (joined.last.accepted, joined.last.effector) == (GRIP.id, True)
    stuck = up("stuck_output")
    stuck.ask(GRIP)
    stuck.wait(2.0)
    assert (stuck.last.accepted, stuck.last.effector) == (None, False)
    assert (stuck.last.rejected, stuck.last.refusal) == (GRIP.id, "output_does_not_follow")


def test_a_grip_is_never_accepted_before_its_output_is_read_back() -> None:
    joined = up()
    joined.reports.clear()
    joined.ask(GRIP)
    joined.wait(0.5)
    assert all(report.effector for report in joined.reports if report.accepted == GRIP.id)


def test_a_boot_has_another_number_and_forgets_every_order() -> None:
    joined = moving()
    before = joined.last.boot_id
    joined.faults.switch("power_cycle", on=True)
    joined.wait(5.0)
    joined.faults.switch("power_cycle", on=False)
    joined.wait(2.0)
    assert joined.last.boot_id != before
    assert (joined.last.state, joined.last.accepted, joined.last.done) == (MotionState.NOT_HOMED, None, None)


def test_a_paused_arm_counts_as_moving() -> None:
    joined = moving()
    joined.tell("Pause()")
    joined.wait(1.0)
    assert joined.last.state is MotionState.MOVING
    joined.tell("Continue()")
    joined.wait(3.0)
    assert joined.last.done == GO.id


def test_nothing_leaves_without_a_connection() -> None:
    joined = Loopback("power_cycle")
    joined.wait(0.1)
    assert joined.ask(GO) == "dobot is not connected"


def test_a_torn_frame_is_left_out_and_the_next_one_counts() -> None:
    joined = up("torn")
    joined.ask(GO)
    joined.wait(3.0)
    assert joined.last.done == GO.id


def test_answers_that_come_late_are_waited_for() -> None:
    joined = up("late_replies")
    joined.ask(GO)
    joined.wait(0.9)
    assert joined.last.accepted is None and joined.last.state is MotionState.MOVING
    joined.wait(3.0)
    assert joined.last.done == GO.id


def test_alarms_are_said_whose_answer_lacks_its_last_brace() -> None:
    joined = moving("no_brace")
    joined.faults.switch("alarm", on=True)
    joined.wait(1.0)
    assert (joined.last.failed, joined.last.failure) == (GO.id, "alarm 17: no joints reach that pose")


def test_control_that_an_enabled_arm_refuses_is_asked_for_again_when_it_is_disabled() -> None:
    joined = up()
    assert joined.received.count("RequestControl()") == 1
    joined.tell("DisableRobot()")
    joined.wait(0.2)
    assert joined.received.count("RequestControl()") == 2
    joined.ask(READY)
    joined.wait(2.0)
    assert joined.received.count("RequestControl()") == 2


@pytest.mark.parametrize("fault", ["script", "stop_button", "alarm", "power_off"])
def test_the_effector_is_unknown_where_its_output_is_not_shown(fault: str) -> None:
    joined = moving()
    joined.ask(GRIP)
    joined.wait(0.1)
    assert joined.last.effector is True
    joined.faults.switch(fault, on=True)
    joined.wait(2.5)
    assert joined.last.effector is None


def test_an_output_that_a_script_keeps_from_being_read_back_is_said_to_be_unread() -> None:
    joined = up("script")
    joined.ask(GRIP)
    joined.wait(0.2)
    assert (joined.last.rejected, joined.last.refusal) == (GRIP.id, "output_not_read_back script_running")


def bare() -> Machine:
    """A machine that is connected, has had its answers, and has seen one frame of an arm that stands."""
    machine = Machine([ARM], Settings(host="dobot"))
    machine.step(0.0, [])
    machine.step(0.0, [Opened()])
    replies = b"0,{},RequestControl();0,{0},GetToolDO(1);"
    machine.step(0.1, [DashboardReply(data=replies), FeedbackData(data=FRAME.packed())])
    return machine


def test_a_move_without_an_answer_is_told_as_such() -> None:
    machine = bare()
    machine.step(0.5, [CommandRequest(command=GO)])
    machine.step(1.0, [FeedbackData(data=replace(FRAME, run_ms=2000).packed())])
    out = machine.step(1.1, [DashboardReply(data=b"0,{0},GetToolDO(1);")])
    (lost,) = [str(each.lost) for each in out if isinstance(each, Report)]
    assert "it has not answered MovJ, and has answered GetToolDO, which it was told later" in lost


@pytest.mark.parametrize(("changes", "lives"), [({}, False), ({"time_ms": 1}, True), ({"run_ms": 1}, True)])
def test_an_arm_lives_by_its_clock_or_its_run_time(changes: dict[str, int], lives: bool) -> None:
    machine, now, frame, lost = bare(), 0.1, FRAME, False
    for _ in range(15):
        now += 0.1
        frame = replace(frame, **{name: getattr(frame, name) + 100 for name in changes})
        out = machine.step(now, [FeedbackData(data=frame.packed())])
        lost = lost or any(isinstance(each, Report) and each.lost is not None for each in out)
    assert lost is not lives
