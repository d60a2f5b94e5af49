"""What is called for a command, what is read, and what that says; on the belt of the example."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.packages import ROOT

from arboleda.drivers import MotionState, NotSent, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_drivers.opcua.machine import Call, OpcUaDevice
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

EXAMPLE = ROOT / "examples/plc_conveyor/opcua.yaml"
BELT = "ns=2;s=Device"


@pytest.fixture(scope="module")
def belt() -> Device:
    (robot,) = load(EXAMPLE).robots.values()
    assert isinstance(robot, Device)
    return robot


@pytest.fixture
def machine(belt: Device) -> OpcUaDevice:
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    made = OpcUaDevice(belt, belt.driver.settings)
    made.begin(shown(made))
    return made


def shown(machine: OpcUaDevice, **values: object) -> dict[str, object]:
    """What the server shows: all 0, except these."""
    return dict.fromkeys(machine.places, 0) | {f"ns=2;s={name}": value for name, value in values.items()}


def told(belt: Device, verb: str, id: str = "c1", **values: object) -> Command:
    return belt.kind.command(id=id, robot="belt", verb=verb, values=values)  # type: ignore[arg-type]


def test_a_verb_is_a_call_with_its_values_and_its_number_last(belt: Device, machine: OpcUaDevice) -> None:
    called = machine.order(told(belt, "advance", to="exit", speed_mm_s=200))
    given = (("uint16", 2), ("uint16", 200), ("uint16", 1))
    assert called == Call(method="ns=2;s=Advance", on=BELT, given=given)


def test_accepted_and_done_name_the_command(belt: Device, machine: OpcUaDevice) -> None:
    machine.order(told(belt, "load"))
    report = machine.report(5.0, shown(machine, accepted=1, done=1, part_at=1))
    assert (report.accepted, report.done, report.state) == ("c1", "c1", MotionState.STOPPED)
    assert dict(report.facts or ()) == {"part_at": "entry", "gate": "closed", "mm_s": 0}


def test_numbers_of_an_earlier_session_name_no_command(belt: Device, machine: OpcUaDevice) -> None:
    machine.begin(shown(machine, accepted=1, done=1))
    machine.order(told(belt, "load"))
    assert machine.report(5.0, shown(machine, accepted=1, done=1)).done is None
    assert machine.report(6.0, shown(machine, accepted=2, done=2)).done == "c1"


def test_a_rejection_and_a_failure_have_their_words(belt: Device, machine: OpcUaDevice) -> None:
    machine.order(told(belt, "load"))
    report = machine.report(5.0, shown(machine, rejected=1, reason=1, failed=1, failure=9))
    assert (report.rejected, report.refusal) == ("c1", "busy")
    assert (report.failed, report.failure) == ("c1", "code 9")


def test_a_query_is_answered_with_its_number(belt: Device, machine: OpcUaDevice) -> None:
    machine.order(told(belt, "scan"))
    waiting = machine.report(5.0, shown(machine, accepted=1, seen=2))
    answered = machine.report(6.0, shown(machine, accepted=1, done=1, seen=2))
    assert (waiting.answered, waiting.answer) == (None, None)
    assert (answered.answered, answered.answer, answered.done) == ("c1", "bad", None)


@pytest.mark.parametrize("name", ["part_at", "gate", "mm_s", "state", "boot", "alive", "done", "reason"])
@pytest.mark.parametrize("value", [None, [1], True, 1.5, float("nan"), -1.5, b"\x00", {}, object()])
def test_no_value_of_another_type_is_a_report(machine: OpcUaDevice, name: str, value: object) -> None:
    with pytest.raises(UnreadableValue, match=f"^ns=2;s={name} is "):
        machine.report(5.0, shown(machine, **{name: value}))


def test_a_value_without_a_word_is_no_report(machine: OpcUaDevice) -> None:
    with pytest.raises(UnreadableValue, match="ns=2;s=part_at is 77, for which there is no word"):
        machine.report(5.0, shown(machine, part_at=77))


def test_a_program_that_stands_still_is_noticed(machine: OpcUaDevice) -> None:
    machine.report(5.0, shown(machine, alive=3))
    machine.report(5.9, shown(machine, alive=3))
    with pytest.raises(
        UnreadableValue, match="the program of the PLC stands still: ns=2;s=alive is 3 for 1 s"
    ):
        machine.report(6.1, shown(machine, alive=3))


def test_stops_have_methods_of_their_own(machine: OpcUaDevice) -> None:
    for mode, name in ((StopMode.HALT, "Halt"), (StopMode.LATCH, "Latch"), (StopMode.CLEAR, "Clear")):
        called = machine.order(Stop(id="s", robot="belt", mode=mode))
        assert called == Call(method=f"ns=2;s={name}", on=BELT)


def test_without_a_latch_a_latch_is_a_halt_and_no_clear_is_no_call(belt: Device) -> None:
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    plain = OpcUaDevice(belt, replace(belt.driver.settings, latch=None, clear=None))
    latched = plain.order(Stop(id="s", robot="belt", mode=StopMode.LATCH))
    assert latched == Call(method="ns=2;s=Halt", on=BELT)
    assert plain.order(Stop(id="s", robot="belt", mode=StopMode.CLEAR)) is None


def test_what_the_mapping_does_not_know_is_not_sent(machine: OpcUaDevice) -> None:
    with pytest.raises(NotSent, match="has no word for Command"):
        machine.order(Command(id="c1", robot="belt"))


def test_what_says_that_it_is_done_is_read_before_the_facts(machine: OpcUaDevice) -> None:
    names = [node.removeprefix("ns=2;s=") for node in machine.places]
    assert names.index("done") < names.index("accepted") < names.index("state") < names.index("part_at")


def test_without_numbers_facts_and_state_are_all_that_is_said(belt: Device) -> None:
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    plain = OpcUaDevice(belt, replace(belt.driver.settings, sequence=None))
    plain.begin(shown(plain))
    assert plain.order(told(belt, "load")) == Call(method="ns=2;s=Load", on=BELT)
    report = plain.report(5.0, shown(plain, state=1, part_at=1))
    assert (report.state, report.fact("part_at")) == (MotionState.MOVING, "entry")
    assert (report.accepted, report.done, report.rejected, report.failed) == (None, None, None, None)
