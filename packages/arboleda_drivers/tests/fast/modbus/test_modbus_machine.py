"""What is written for a command, what is read, and what that says; on the belt of the example."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.packages import ROOT

from arboleda.drivers import MotionState, NotSent, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_drivers.modbus.machine import Block, ModbusDevice, Raw, WriteRequest, blocks, joined
from arboleda_drivers.modbus.registers import Register
from arboleda_drivers.modbus.settings import Settings
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

EXAMPLE = ROOT / "examples/plc_conveyor/plant.yaml"


@pytest.fixture(scope="module")
def belt() -> Device:
    (robot,) = load(EXAMPLE).robots.values()
    assert isinstance(robot, Device)
    return robot


@pytest.fixture
def machine(belt: Device) -> ModbusDevice:
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    made = ModbusDevice(belt, belt.driver.settings)
    made.begin(shown())
    return made


def shown(**inputs: int) -> Raw:
    """What the PLC shows: all 0, except these, `i4=7`."""
    raw = {("input", at): 0 for at in range(13)} | {("discrete", 0): 0, ("holding", 3): 0}
    return raw | {("input", int(name[1:])): value for name, value in inputs.items()}


def told(belt: Device, verb: str, id: str = "c1", **values: object) -> Command:
    return belt.kind.command(id=id, robot="belt", verb=verb, values=values)  # type: ignore[arg-type]


def test_a_verb_its_values_and_its_number_leave_in_one_request(belt: Device, machine: ModbusDevice) -> None:
    puts = machine.order(told(belt, "advance", to="exit", speed_mm_s=200))
    assert puts == (WriteRequest(table="holding", address=0, values=(2, 2, 200, 1)),)


def test_the_number_is_written_last(belt: Device, machine: ModbusDevice) -> None:
    *_, last = machine.order(told(belt, "load"))
    assert last == WriteRequest(table="holding", address=3, values=(1,))


def test_accepted_and_done_name_the_command(belt: Device, machine: ModbusDevice) -> None:
    machine.order(told(belt, "load"))
    report = machine.report(5.0, shown(i3=1, i4=1, i10=1))
    assert (report.accepted, report.done, report.state) == ("c1", "c1", MotionState.STOPPED)
    assert dict(report.facts or ()) == {"part_at": "entry", "gate": "closed", "mm_s": 0}


def test_numbers_of_an_earlier_start_name_no_command(belt: Device, machine: ModbusDevice) -> None:
    machine.begin(shown(i3=1, i4=1))
    machine.order(told(belt, "load"))
    assert machine.report(5.0, shown(i3=1, i4=1)).done is None
    assert machine.report(6.0, shown(i3=2, i4=2)).done == "c1"


def test_a_rejection_and_a_failure_have_their_words(belt: Device, machine: ModbusDevice) -> None:
    machine.order(told(belt, "load"))
    report = machine.report(5.0, shown(i5=1, i6=1, i7=1, i8=9))
    assert (report.rejected, report.refusal) == ("c1", "busy")
    assert (report.failed, report.failure) == ("c1", "code 9")


def test_a_query_is_answered_with_its_number(belt: Device, machine: ModbusDevice) -> None:
    machine.order(told(belt, "scan"))
    waiting = machine.report(5.0, shown(i3=1, i12=2))
    answered = machine.report(6.0, shown(i3=1, i4=1, i12=2))
    assert (waiting.answered, waiting.answer) == (None, None)
    assert (answered.answered, answered.answer, answered.done) == ("c1", "bad", None)


def test_a_value_without_a_word_is_no_report(machine: ModbusDevice) -> None:
    with pytest.raises(UnreadableValue, match="input 10 is 77, for which there is no word"):
        machine.report(5.0, shown(i10=77))


def test_a_program_that_stands_still_is_noticed(machine: ModbusDevice) -> None:
    machine.report(5.0, shown(i1=3))
    machine.report(5.9, shown(i1=3))
    with pytest.raises(UnreadableValue, match="the program of the PLC stands still: input 1 is 3 for 1 s"):
        machine.report(6.1, shown(i1=3))


def test_stops_have_writes_of_their_own(machine: ModbusDevice) -> None:
    def stop(mode: StopMode) -> tuple[WriteRequest, ...]:
        return machine.order(Stop(id="s", robot="belt", mode=mode))

    assert stop(StopMode.HALT) == (WriteRequest(table="coil", address=0, values=(1,)),)
    assert stop(StopMode.LATCH) == (WriteRequest(table="coil", address=1, values=(1,)),)
    assert stop(StopMode.CLEAR) == (WriteRequest(table="coil", address=1, values=(0,)),)


def test_what_the_mapping_does_not_know_is_not_sent(machine: ModbusDevice) -> None:
    with pytest.raises(NotSent, match="has no word for Command"):
        machine.order(Command(id="c1", robot="belt"))


def test_neighbours_are_read_together_and_gaps_are_not_read() -> None:
    places = [Register(input=3), Register(input=4, type="uint32"), Register(input=7), Register(holding=6)]
    assert blocks(places) == (
        Block(table="input", address=3, length=3),
        Block(table="input", address=7, length=1),
        Block(table="holding", address=6, length=1),
    )


def test_what_says_that_it_is_done_is_read_before_the_facts(machine: ModbusDevice) -> None:
    tables = [(block.table, block.address) for block in machine.blocks]
    assert tables == [("input", 0), ("input", 10), ("discrete", 0)]


def test_writes_keep_their_order() -> None:
    first, second = (
        WriteRequest(table="holding", address=5, values=(1,)),
        WriteRequest(table="holding", address=4, values=(2,)),
    )
    assert joined([first, second]) == (first, second)


def test_without_numbers_facts_and_state_are_all_that_is_said(belt: Device) -> None:
    assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
    plain = ModbusDevice(belt, replace(belt.driver.settings, sequence=None))
    plain.begin(shown())
    assert plain.order(told(belt, "load")) == (WriteRequest(table="holding", address=0, values=(1,)),)
    report = plain.report(5.0, shown(i2=1, i3=1, i4=1, i10=1))
    assert (report.state, report.fact("part_at")) == (MotionState.MOVING, "entry")
    assert (report.accepted, report.done, report.rejected, report.failed) == (None, None, None, None)
