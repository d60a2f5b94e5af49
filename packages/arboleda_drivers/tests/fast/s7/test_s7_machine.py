"""The driver's machine of an S7 at the bytes of its data blocks; the handshake is tried with OPC UA."""

from __future__ import annotations

import pytest
from tests.packages import ROOT

from arboleda.drivers import Home, NotSent, Report, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.messages import MotionState
from arboleda.plant_file.loader import load
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.s7.machine import LEAST_PDU, S7Device, Writing
from arboleda_drivers.s7.settings import Settings
from arboleda_drivers.s7.virtual.memory import FAULTS, BeltMemory
from arboleda_drivers.virtual.faults import Faults

EXAMPLE = ROOT / "examples/plc_conveyor/s7.yaml"


@pytest.fixture(scope="module")
def belt() -> Device:
    (robot,) = load(EXAMPLE).robots.values()
    assert isinstance(robot, Device)
    return robot


class Wire:
    """The driver's machine and the belt's data blocks, under time moved by hand; a request may take some."""

    request_s = 0.0

    def __init__(self, belt: Device, *faults: str) -> None:
        assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
        self.now = 100.0
        self.memory = BeltMemory(Faults(FAULTS, faults), lambda: self.now)
        self.machine = S7Device(belt, belt.driver.settings)
        self._belt = belt
        self.machine.begin(self.machine.values(self._raw()))

    def order(self, verb: str, **values: object) -> Writing:
        command = self._belt.kind.command(id="c1", robot="belt", verb=verb, values=values)  # type: ignore[arg-type]
        return self.machine.order(command)

    def write(self, writing: Writing) -> None:
        for put in writing.puts:
            self.memory.write(put.place.db, put.place.byte, put.raw)

    def after(self, seconds: float) -> Report:
        self.now += seconds
        return self.machine.report(self.now, self.machine.values(self._raw()))

    def _raw(self) -> dict[object, bytes]:
        raw: dict[object, bytes] = {}
        for each in self.machine.blocks(LEAST_PDU):
            raw[each] = self.memory.read(each.db)[each.byte : each.byte + each.length]
            self.now += self.request_s
        return raw


def test_an_order_is_its_values_and_then_its_number(belt: Device) -> None:
    writing = Wire(belt).order("advance", to="exit", speed_mm_s=200)
    written = [(put.place.text, put.raw) for put in writing.puts]
    assert written == [
        ("DB2.DBB0", b"\2"),
        ("DB2.DBW2:INT", b"\0\2"),
        ("DB2.DBD4:DINT", b"\0\0\0\xc8"),
        ("DB2.DBW8", b"\0\1"),
    ]
    assert writing.begins_last


def test_a_belt_that_gives_up_between_two_requests_has_not_just_stopped(belt: Device) -> None:
    wire = Wire(belt, "gives_up")
    wire.write(wire.order("load"))
    wire.request_s = 0.3
    reports = [wire.after(0.0) for _ in range(3)]
    stopped = next(each for each in reports if each.state is MotionState.STOPPED)
    assert (stopped.failed, stopped.failure) == ("c1", "jam")


def test_a_part_is_loaded_and_the_echo_says_so(belt: Device) -> None:
    wire = Wire(belt)
    wire.write(wire.order("load"))
    assert wire.after(0.1).accepted == "c1"
    report = wire.after(1.0)
    assert (report.done, dict(report.facts)["part_at"]) == ("c1", "entry")


def test_an_answer_comes_with_its_number(belt: Device) -> None:
    wire = Wire(belt, "bad_part")
    wire.write(wire.order("scan"))
    assert wire.after(0.1).answered is None
    assert (wire.after(0.5).answered, wire.after(0.1).answer) == ("c1", "bad")


def test_a_stop_is_written_without_a_number(belt: Device) -> None:
    wire = Wire(belt)
    for mode, text in {StopMode.HALT: "DB2.DBX12.0", StopMode.LATCH: "DB2.DBX13.0"}.items():
        (put,) = wire.machine.order(Stop(id="s", robot="belt", mode=mode)).puts
        assert (put.place.text, put.raw) == (text, b"\1")
    (clear,) = wire.machine.order(Stop(id="s", robot="belt", mode=StopMode.CLEAR)).puts
    assert clear.raw == b"\0"


def test_a_number_without_a_word_is_no_report(belt: Device) -> None:
    wire = Wire(belt)
    wire.after(0.1)
    broken = Wire(belt, "nonsense")
    with pytest.raises(UnreadableValue, match=r"DB1\.DBW18 is 77, for which there is no word"):
        broken.after(0.1)


def test_what_is_not_mapped_does_not_leave(belt: Device) -> None:
    with pytest.raises(NotSent, match="has no word for Home"):
        Wire(belt).machine.order(Home(id="c1", robot="belt"))
