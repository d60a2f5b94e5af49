"""The driver of a Dobot against a virtual one, with time moved by hand: what the plant hears of it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.drivers import MotionState, Report, Stop, StopMode
from arboleda_drivers.connections.link import CommandRequest, Opened
from arboleda_drivers.dobot.dashboard import SendLine
from arboleda_drivers.dobot.frames import Feedback, Mode
from arboleda_drivers.dobot.machine import DashboardReply, FeedbackData, Machine
from arboleda_drivers.dobot.settings import Settings

from ..connections.arms import ARM, CLEAR, GO, GRIP, LATCH, READY, Dobot

FRAME = Feedback(mode=Mode.IDLE, command=0, joints_deg=(0.0,) * 6, time_ms=1_700_000_000_000, run_ms=1000)


def up(*faults: str, ready: bool = True) -> Dobot:
    joined = Dobot(*faults, ready=ready)
    joined.wait(0.5)
    return joined


def moving(*faults: str) -> Dobot:
    """An arm that is on its way, before half of it."""
    joined = up(*faults)
    assert joined.ask(GO) is None
    joined.wait(0.2)
    return joined


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
    joined = Dobot("power_off", ready=False)
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


def test_a_paused_arm_counts_as_moving() -> None:
    joined = moving()
    joined.tell("Pause()")
    joined.wait(1.0)
    assert joined.last.state is MotionState.MOVING
    joined.tell("Continue()")
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
    assert (joined.last.failed, joined.last.failure) == (GRIP.id, "output_not_read_back script_running")


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
    machine.step(1.0, [CommandRequest(command=Stop(id="c9", robot=ARM.name, mode=StopMode.HALT))])
    out = machine.step(1.1, [DashboardReply(data=b"0,{},Stop();")])
    (lost,) = [str(each.lost) for each in out if isinstance(each, Report)]
    assert "it has not answered MovJ, and has answered Stop, which it was told later" in lost


def test_its_output_is_not_asked_for_again_before_an_answer() -> None:
    machine = bare()
    asked = [each for at in range(2, 30) for each in machine.step(at / 10, [fresh(at)])]
    assert [each.text for each in asked if isinstance(each, SendLine)] == ["GetToolDO(1)"]


def fresh(at: int) -> FeedbackData:
    """A frame of an arm that stands, so many tenths of a second later."""
    return FeedbackData(data=replace(FRAME, run_ms=FRAME.run_ms + 100 * at).packed())


@pytest.mark.parametrize(("changes", "lives"), [({}, False), ({"time_ms": 1}, True), ({"run_ms": 1}, True)])
def test_an_arm_lives_by_its_clock_or_its_run_time(changes: dict[str, int], lives: bool) -> None:
    machine, now, frame, lost = bare(), 0.1, FRAME, False
    for _ in range(15):
        now += 0.1
        frame = replace(frame, **{name: getattr(frame, name) + 100 for name in changes})
        out = machine.step(now, [FeedbackData(data=frame.packed())])
        lost = lost or any(isinstance(each, Report) and each.lost is not None for each in out)
    assert lost is not lives
