"""The driver of Universal Robots against a virtual arm, with time moved by hand."""

from __future__ import annotations

import math

import pytest

from arboleda.drivers import MotionState, Report
from arboleda.model.facts import HEALTH
from arboleda_drivers.connections.link import Open, Opened
from arboleda_drivers.ur.machine import Machine
from arboleda_drivers.ur.port_data import RTDE, Send
from arboleda_drivers.ur.settings import SLIDER, Settings

from ..connections.arms import ARM, GO, GOAL, GRIP, HALT, READY, Ur


def up(*faults: str, ready: bool = True) -> Ur:
    joined = Ur(*faults, ready=ready)
    joined.wait(0.5)
    return joined


def moving(*faults: str) -> Ur:
    """An arm that is on its way, before half of it."""
    joined = up(*faults)
    assert joined.ask(GO) is None
    joined.wait(0.2)
    return joined


def fact(report: Report, name: str) -> object:
    return dict(report.facts or ())[name]


def test_a_program_names_itself_by_a_number_that_none_before_it_had() -> None:
    joined = moving()
    joined.wait(3.0)
    joined.driver = Machine([ARM], Settings(host="ur"))  # the plant was started again
    joined.wait(1.0)
    joined.ask(GO)
    assert "write_output_integer_register(24, 2)" in joined.programs[-1]


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
    joined = up(ready=False)
    assert (joined.last.state, joined.last.homed) == (MotionState.NOT_HOMED, False)
    joined.ask(READY)
    joined.wait(5.0, until=lambda report: report.done is not None)
    assert (joined.last.done, joined.last.homed, joined.last.q) == (READY.id, True, (0.0,) * 6)
    assert "power on" in joined.lines and "brake release" in joined.lines and not joined.programs


def test_brakes_that_are_not_released_are_said() -> None:
    joined = up("brakes_stuck", ready=False)
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


def test_the_effector_is_what_the_controller_reads_back() -> None:
    joined = up()
    assert joined.last.effector is False
    joined.ask(GRIP)
    joined.wait(0.2)
    assert (joined.last.accepted, joined.last.effector) == (GRIP.id, True)
    assert "set_tool_digital_out(0, True)" in joined.programs[-1]


def test_the_speed_slider_is_a_fact() -> None:
    joined = up("slider")
    assert fact(joined.last, SLIDER) == 3
    joined.ask(GO)
    joined.wait(1.0)
    assert joined.last.q is not None and joined.last.q[0] < GOAL[0] / 5


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
