"""The driver of Universal Robots against a virtual arm, with time moved by hand."""

from __future__ import annotations

import math

import pytest

from arboleda.drivers import Home, MotionState, Report, SetEffector, Stop, StopMode
from arboleda.model.facts import HEALTH
from arboleda_drivers.connections.link import CommandRequest, Open, Opened
from arboleda_drivers.ur.machine import Machine
from arboleda_drivers.ur.port_data import RTDE, Send
from arboleda_drivers.ur.settings import SLIDER, Settings

from .ur_rig import ARM, GO, GOAL, Loopback

HALT = Stop(id="9-5", robot=ARM.name, mode=StopMode.HALT)
LATCH = Stop(id="9-6", robot=ARM.name, mode=StopMode.LATCH)
CLEAR = Stop(id="9-7", robot=ARM.name, mode=StopMode.CLEAR)
READY = Home(id="9-2", robot=ARM.name)
GRIP = SetEffector(id="9-3", robot=ARM.name, on=True)


def up(*faults: str, running: bool = True) -> Loopback:
    joined = Loopback(*faults, running=running)
    joined.wait(0.5)
    return joined


def moving(*faults: str) -> Loopback:
    """An arm that is on its way, before half of it."""
    joined = up(*faults)
    assert joined.ask(GO) is None
    joined.wait(0.2)
    return joined


def fact(report: Report, name: str) -> object:
    return dict(report.facts or ())[name]


def test_a_move_is_accepted_and_done_at_its_goal() -> None:
    joined = moving()
    assert (joined.last.accepted, joined.last.state) == (GO.id, MotionState.MOVING)
    joined.wait(3.0, until=lambda report: report.done is not None)
    end = joined.last
    assert (end.done, end.state, end.q) == (GO.id, MotionState.STOPPED, pytest.approx(GOAL, abs=1e-5))
    assert len(joined.programs) == 1


def test_a_program_names_itself_by_a_number_that_none_before_it_had() -> None:
    joined = moving()
    joined.wait(3.0)
    joined.driver = Machine([ARM], Settings(host="ur"))  # the plant was started again
    joined.wait(1.0)
    joined.ask(GO)
    assert "write_output_integer_register(24, 2)" in joined.programs[-1]


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
        ("refuse", "program_refused line 1: refused"),
        ("not_begun", "not_begun"),
        ("popup", "not_begun"),
        ("echo_lost", "not_begun"),
        ("local_control", "local_control"),
    ],
)
def test_a_refusal_has_its_reason(fault: str, word: str) -> None:
    joined = up(fault)
    joined.ask(GO)
    joined.wait(2.5)
    assert joined.last.rejected == GO.id and joined.last.refusal == word
    assert joined.last.done is None


@pytest.mark.parametrize(
    ("fault", "words"),
    [
        ("protective_stop", "protective_stop"),
        ("safeguard", "safeguard_stop"),
        ("stop_button", "robot_stop_button"),
        ("power_off", "power_off"),
        ("brakes_stuck", "brakes_not_released"),
        ("program_stopped", "program_stopped"),
        ("joint_limit", "program_stopped line 4: joint limit"),
        ("local_control", "program_stopped"),
        ("heartbeat_lost", "program_stopped"),
        ("other_program", "program_stopped"),
    ],
)
def test_a_move_that_breaks_off_fails_with_the_reason(fault: str, words: str) -> None:
    joined = moving(*(["slow"] if fault == "heartbeat_lost" else []))
    joined.faults.switch(fault, on=True)
    joined.wait(3.0)
    assert (joined.last.failed, joined.last.failure) == (GO.id, words)
    assert joined.last.done is None


def test_a_protective_stop_is_a_fact_and_home_leads_out_of_it_without_resuming_anything() -> None:
    joined = moving()
    joined.faults.switch("protective_stop", on=True)
    joined.wait(2.0)
    joined.faults.switch("protective_stop", on=False)
    assert (joined.last.state, fact(joined.last, HEALTH)) == (MotionState.FAULT, "protective_stop")
    rest = joined.last.q
    joined.ask(READY)
    joined.wait(10.0, until=lambda report: report.done is not None)
    assert (joined.last.done, joined.last.state) == (READY.id, MotionState.STOPPED)
    assert (fact(joined.last, HEALTH), joined.last.homed) == ("ok", True)
    joined.wait(5.0)
    assert joined.last.q == rest


def test_a_safeguard_that_is_closed_again_resumes_nothing() -> None:
    joined = moving()
    joined.faults.switch("safeguard", on=True)
    joined.wait(1.0)
    rest = joined.last.q
    joined.faults.switch("safeguard", on=False)
    joined.wait(5.0)
    assert (joined.last.q, joined.last.state, joined.last.done) == (rest, MotionState.STOPPED, None)


def test_home_says_what_a_person_has_to_end() -> None:
    joined = up("safeguard")
    joined.ask(READY)
    joined.wait(0.5)
    assert (joined.last.failed, joined.last.failure) == (READY.id, "safeguard_stop")


def test_home_powers_the_arm_and_releases_its_brakes_and_moves_nothing() -> None:
    joined = up(running=False)
    assert (joined.last.state, joined.last.homed) == (MotionState.NOT_HOMED, False)
    joined.ask(READY)
    joined.wait(5.0, until=lambda report: report.done is not None)
    assert (joined.last.done, joined.last.homed, joined.last.q) == (READY.id, True, (0.0,) * 6)
    assert "power on" in joined.lines and "brake release" in joined.lines and not joined.programs


def test_brakes_that_are_not_released_are_said() -> None:
    joined = up("brakes_stuck", running=False)
    joined.ask(READY)
    joined.wait(25.0, until=lambda report: report.failed is not None)
    assert (joined.last.failed, joined.last.failure) == (READY.id, "brakes_not_released Brake releasing")


def test_nothing_is_begun_in_local_control_and_home_says_so() -> None:
    joined = up("local_control")
    joined.wait(1.5)
    assert fact(joined.last, HEALTH) == "local_control"
    for each in (READY, GRIP):
        joined.ask(each)
        joined.wait(0.2)
        assert (joined.last.rejected, joined.last.refusal) == (each.id, "local_control")


def test_it_connects_anew_once_it_is_in_remote_control_again() -> None:
    joined = up("local_control")
    joined.ask(GO)  # before the dashboard was asked: the interface for programs is read-only from now on
    joined.wait(0.2)
    assert joined.last.refusal == "local_control"
    joined.faults.switch("local_control", on=False)
    joined.wait(3.0)
    joined.ask(GO)
    joined.wait(3.0, until=lambda report: report.done is not None)
    assert joined.last.done == GO.id


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        ("mute", "stood still"),
        ("frozen", "stood still"),
        ("garbled", "stood still"),
        ("torn", "a packet of type"),
        ("dashboard_mute", "has not answered is in remote control for 2 s"),
        ("unasked_replies", "nobody asked"),
        ("old_rtde", "does not speak version 2"),
        ("in_use", "another client of RTDE writes input_int_register_24"),
        ("connections_full", "refused"),
        ("reboot", "refused"),
    ],
)
def test_a_controller_that_does_not_make_sense_has_no_link(fault: str, why: str) -> None:
    joined = moving()
    joined.faults.switch(fault, on=True)
    joined.wait(4.0)
    assert any(report.lost is not None and why in str(report.lost) for report in joined.reports)


def test_frames_that_come_seldom_are_enough() -> None:
    joined = up("rate_drops")
    joined.ask(GO)
    joined.wait(5.0, until=lambda report: report.done is not None)
    assert joined.last.done == GO.id


@pytest.mark.parametrize("fault", ["late_start", "late_runtime", "slow", "late_replies"])
def test_what_is_late_is_waited_for(fault: str) -> None:
    joined = up(fault)
    joined.ask(GO)
    joined.wait(8.0, until=lambda report: report.done is not None)
    assert (joined.last.done, joined.last.q) == (GO.id, pytest.approx(GOAL, abs=1e-5))


def test_what_was_left_at_work_is_stopped_by_who_comes_back() -> None:
    joined = moving()
    joined.faults.switch("mute", on=True)
    joined.wait(1.2)
    joined.faults.switch("mute", on=False)
    joined.programs.clear()
    joined.wait(2.0)
    assert ["stopj" in each for each in joined.programs] == [True]
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


def test_a_stop_whose_program_does_not_begin_is_said_to_the_dashboard() -> None:
    joined = moving()
    joined.faults.switch("not_begun", on=True)
    joined.ask(HALT)
    joined.wait(2.0)
    assert "stop" in joined.lines
    assert (joined.last.accepted, joined.last.state) == (HALT.id, MotionState.STOPPED)


def test_a_stop_that_nobody_takes_is_refused_and_the_arm_is_not_said_to_rest() -> None:
    joined = moving()
    joined.faults.switch("local_control", on=True)
    joined.ask(HALT)
    joined.wait(0.9)
    assert (joined.last.rejected, joined.last.refusal) == (HALT.id, "local_control")


def test_an_arm_that_moves_on_after_a_stop_is_not_said_to_rest() -> None:
    joined = moving("slow")
    joined.faults.switch("deaf", on=True)
    joined.ask(HALT)
    joined.wait(1.0)
    assert (joined.last.accepted, joined.last.state) == (HALT.id, MotionState.MOVING)


def test_a_latch_is_said_until_it_is_cleared() -> None:
    joined = up()
    joined.ask(LATCH)
    joined.wait(1.0)
    assert joined.last.state is MotionState.STOP_LATCHED
    joined.ask(CLEAR)
    joined.wait(0.2)
    assert joined.last.state is MotionState.STOPPED


def test_the_effector_is_what_the_controller_reads_back() -> None:
    joined = up()
    assert joined.last.effector is False
    joined.ask(GRIP)
    joined.wait(0.2)
    assert (joined.last.accepted, joined.last.effector) == (GRIP.id, True)
    assert "set_tool_digital_out(0, True)" in joined.programs[-1]


def test_an_output_that_does_not_follow_is_refused() -> None:
    joined = up("stuck_output")
    joined.ask(GRIP)
    joined.wait(1.5)
    assert (joined.last.rejected, joined.last.refusal) == (GRIP.id, "output_does_not_follow")


def test_the_speed_slider_is_a_fact() -> None:
    joined = up("slider")
    assert fact(joined.last, SLIDER) == 3
    joined.ask(GO)
    joined.wait(1.0)
    assert joined.last.q is not None and joined.last.q[0] < GOAL[0] / 5


def test_a_boot_forgets_what_was_open() -> None:
    joined = moving()
    before = joined.last.boot_id
    joined.faults.switch("reboot", on=True)
    joined.wait(20.0)
    joined.faults.switch("reboot", on=False)
    joined.wait(2.0)
    assert joined.last.boot_id != before and joined.last.state is MotionState.NOT_HOMED
    assert (joined.last.accepted, joined.last.done) == (None, None)


def test_another_command_is_refused_while_it_is_at_work() -> None:
    joined = moving()
    joined.ask(READY)
    joined.wait(0.1)
    assert (joined.last.rejected, joined.last.refusal) == (READY.id, "busy")


def test_the_controller_ends_our_program_where_no_heartbeat_comes() -> None:
    joined = moving("slow")
    for _ in range(30):  # the driver's process is gone
        joined.now += 0.1
        joined.ur.step(joined.now, [])
    assert 0 < joined.ur.run.drive.joints[0] < GOAL[0] * 0.8


def test_who_only_listens_writes_nothing_to_the_controller() -> None:
    machine = Machine([ARM], Settings(host="ur"), only_listens=True)
    assert machine.step(0.0, []) == [Open()]
    out = machine.step(0.0, [Opened()])
    out += machine.step(0.5, [])
    assert {(each.port, each.data[2:3]) for each in out if isinstance(each, Send)} <= {(RTDE, b"V")}


def test_without_a_connection_a_command_does_not_leave() -> None:
    machine = Machine([ARM], Settings(host="ur"))
    (out,) = [each for each in machine.step(0.0, [CommandRequest(command=GO)]) if not isinstance(each, Open)]
    assert out.why == "ur is not connected"


def test_speed_and_acceleration_are_of_the_leading_joint_and_percent_of_the_model() -> None:
    joined = up()
    joined.driver = Machine([ARM], Settings(host="ur", speed_percent=50, acceleration_percent=25))
    joined.wait(1.0)
    joined.ask(GO)
    leading = ARM.joints[2]  # it has the longest way
    assert f"a={leading.acceleration / 4:.4f}, v={leading.speed / 2:.4f})" in joined.programs[-1]


@pytest.mark.parametrize(
    ("settings", "why"),
    [
        ({"speed_percent": 0}, "speed_percent is 0; allowed: 1 to 100"),
        ({"output": 18}, "output is 18; allowed: 0 to 17"),
        ({"registers_from": 47}, "registers_from is 47; allowed: 0 to 46"),
        ({"stop_deg_s2": 0.5}, "stop_deg_s2 is 0.5; allowed: 1 to 2000"),
        ({"stop_deg_s2": math.nan}, "stop_deg_s2 is nan; allowed: 1 to 2000"),
        ({"rtde_port": 29999}, "port, rtde_port and script_port must differ"),
    ],
)
def test_settings_that_cannot_be_are_refused(settings: dict[str, float], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        Settings(host="ur", **settings)  # type: ignore[arg-type]


def test_it_asks_the_dashboard_only_for_what_it_needs() -> None:
    joined = up()
    joined.wait(3.0)
    assert set(joined.lines) == {"is in remote control"}
