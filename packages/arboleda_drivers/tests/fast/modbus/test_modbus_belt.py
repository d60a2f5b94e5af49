"""The belt that `arboleda virtual modbus` plays, and what the driver reports of each of its faults."""

from __future__ import annotations

import pytest
from tests.packages import ROOT

from arboleda.drivers import MotionState, Report, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_drivers.modbus.machine import ModbusDevice, Raw
from arboleda_drivers.modbus.settings import Settings
from arboleda_drivers.modbus.virtual.memory import DEVICE_BUSY, FAULTS, ILLEGAL_ADDRESS, BeltMemory
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.virtual.faults import Faults

EXAMPLE = ROOT / "examples/plc_conveyor/plant.yaml"


@pytest.fixture(scope="module")
def belt() -> Device:
    (robot,) = load(EXAMPLE).robots.values()
    assert isinstance(robot, Device)
    return robot


class Line:
    """The driver's machine and the belt's memory, under time moved by hand."""

    def __init__(self, belt: Device, *faults: str) -> None:
        assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
        self.now = 100.0
        self.faults = Faults(FAULTS, faults)
        self.memory = BeltMemory(self.faults, lambda: self.now)
        self.machine = ModbusDevice(belt, belt.driver.settings)
        self._belt = belt
        self.machine.begin(self._read(self.machine.first_blocks))

    def tell(self, verb: str, **values: object) -> None:
        self.send(self._belt.kind.command(id="c1", robot="belt", verb=verb, values=values))  # type: ignore[arg-type]

    def send(self, command: Command) -> None:
        for put in self.machine.order(command):
            assert self.memory.write(put.table, put.address, list(put.values)) is None

    def after(self, seconds: float) -> Report:
        """What is reported after a while, in which it was polled."""
        until = self.now + seconds
        while self.now < until:
            self.now += 0.1
            report = self.machine.report(self.now, self._read(self.machine.blocks))
        return report

    def _read(self, blocks: object) -> Raw:
        raw = {}
        for block in blocks:  # type: ignore[attr-defined]
            values = self.memory.read(block.table, block.address, block.length)
            assert isinstance(values, list)
            raw |= {(block.table, block.address + at): value for at, value in enumerate(values)}
        return raw


def test_a_part_is_carried_to_the_exit(belt: Device) -> None:
    line = Line(belt)
    line.tell("load")
    assert line.after(0.5).state is MotionState.MOVING
    assert line.after(1.0).fact("part_at") == "entry"
    line.tell("gate", to="open")
    line.tell("advance", to="exit", speed_mm_s=200)
    assert line.after(0.5).fact("mm_s") == 200
    report = line.after(1.5)
    assert (report.done, report.state, report.fact("part_at")) == ("c1", MotionState.STOPPED, "exit")


def test_a_question_is_answered(belt: Device) -> None:
    line = Line(belt)
    line.tell("scan")
    assert line.after(0.1).answered is None
    assert (line.after(0.5).answered, line.after(0.1).answer) == ("c1", "good")


def test_a_closed_gate_rejects(belt: Device) -> None:
    line = Line(belt)
    line.tell("advance", to="exit", speed_mm_s=200)
    assert line.after(0.1).refusal == "gate_closed"


def test_a_halt_ends_work_and_a_latch_refuses_more(belt: Device) -> None:
    line = Line(belt)
    line.tell("load")
    line.send(Stop(id="s", robot="belt", mode=StopMode.LATCH))
    report = line.after(2.0)
    assert (report.state, report.done) == (MotionState.STOP_LATCHED, None)
    line.tell("load")
    assert line.after(0.1).refusal == "latched"
    line.send(Stop(id="s", robot="belt", mode=StopMode.CLEAR))
    assert line.after(0.1).state is MotionState.STOPPED


def test_it_stops_by_itself_when_the_heartbeat_ends(belt: Device) -> None:
    line = Line(belt, "slow")
    line.tell("load")
    line.memory.write("holding", 4, [1])
    assert line.after(1.9).state is MotionState.MOVING
    assert line.after(0.5).state is MotionState.STOPPED


@pytest.mark.parametrize(
    ("fault", "field", "value"),
    [
        ("busy", "refusal", "busy"),
        ("deaf", "accepted", None),
        ("slow", "state", MotionState.MOVING),
        ("jam", "state", MotionState.MOVING),
        ("gives_up", "failure", "jam"),
        ("forgets", "done", None),
        ("drive_fault", "state", MotionState.FAULT),
        ("reboots", "boot_id", 2),
    ],
)
def test_a_fault_shows_in_what_is_reported(belt: Device, fault: str, field: str, value: object) -> None:
    sound, faulty = Line(belt), Line(belt, fault)
    for line in (sound, faulty):
        line.tell("load")
    assert getattr(faulty.after(3.0), field) == value
    assert getattr(sound.after(3.0), field) != value


@pytest.mark.parametrize("fault", ["lies", "blind"])
def test_done_without_the_fact_is_reported_as_such(belt: Device, fault: str) -> None:
    line = Line(belt, fault)
    line.tell("load")
    report = line.after(2.0)
    assert (report.done, report.fact("part_at")) == ("c1", "none")


@pytest.mark.parametrize(("fault", "why"), [("frozen", "stands still"), ("nonsense", "input 10 is 77")])
def test_what_cannot_be_believed_is_no_report(belt: Device, fault: str, why: str) -> None:
    line = Line(belt)
    line.after(0.2)
    line.faults.switch(fault, on=True)
    with pytest.raises(UnreadableValue, match=why):
        line.after(2.0)


def test_a_halt_may_not_halt_and_the_eye_may_see_a_bad_part(belt: Device) -> None:
    line = Line(belt, "runs_on", "bad_part", "slow")
    line.tell("load")
    line.send(Stop(id="s", robot="belt", mode=StopMode.HALT))
    assert line.after(0.5).state is MotionState.MOVING
    line.after(10)
    line.tell("scan")
    assert line.after(4.0).answer == "bad"


def test_faults_of_the_line(belt: Device) -> None:
    line = Line(belt)
    packet = bytes([0, 1, 0, 0, 0, 5, 1, 3, 2, 0, 7])
    assert line.memory.trace(True, packet) == packet
    line.faults.switch("wrong_unit", on=True)
    assert line.memory.trace(True, packet)[6] == 0
    line.faults.switch("noise", on=True)
    assert line.memory.trace(True, packet) != packet
    line.faults.switch("mute", on=True)
    assert (line.memory.trace(True, packet), line.memory.trace(False, packet)) == (b"", packet)
    line.faults.switch("refuses_reads", on=True)
    line.faults.switch("refuses_writes", on=True)
    assert line.memory.read("input", 0, 1) == ILLEGAL_ADDRESS
    assert line.memory.write("coil", 0, [1]) == DEVICE_BUSY


def test_there_are_more_than_ten_faults() -> None:
    assert len(FAULTS) >= 10
