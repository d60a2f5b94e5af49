"""The belt that `arboleda virtual opcua` plays; the faults of its program are tried in test_modbus_belt."""

from __future__ import annotations

import pytest
from tests.packages import ROOT

from arboleda.drivers import MotionState, Report, Stop, StopMode
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_drivers.opcua.machine import OpcUaDevice, Read
from arboleda_drivers.opcua.server import Bad
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.opcua.virtual.faults import FAULTS
from arboleda_drivers.opcua.virtual.program import BeltProgram
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.virtual.faults import Faults

EXAMPLE = ROOT / "examples/plc_conveyor/opcua.yaml"


@pytest.fixture(scope="module")
def belt() -> Device:
    (robot,) = load(EXAMPLE).robots.values()
    assert isinstance(robot, Device)
    return robot


class Line:
    """The driver's machine and the belt's program, under time moved by hand."""

    def __init__(self, belt: Device, *faults: str) -> None:
        assert belt.driver is not None and isinstance(belt.driver.settings, Settings)
        self.now = 100.0
        self.faults = Faults(FAULTS, faults)
        self.program = BeltProgram(self.faults, lambda: self.now)
        self.machine = OpcUaDevice(belt, belt.driver.settings)
        self._belt = belt
        self.machine.begin(self._read())

    def tell(self, verb: str, **values: object) -> str | None:
        return self.send(self._belt.kind.command(id="c1", robot="belt", verb=verb, values=values))  # type: ignore[arg-type]

    def send(self, command: Command) -> str | None:
        order = self.machine.order(command)
        assert order is not None
        return self.program.call(order.method.removeprefix("ns=2;s="), [value for _, value in order.given])

    def after(self, seconds: float) -> Report:
        """What is reported after a while, in which it was read."""
        until = self.now + seconds
        while self.now < until:
            self.now += 0.1
            report = self.machine.report(self.now, self._read())
        return report

    def _read(self) -> Read:
        return {f"ns=2;s={name}": value for name, value in self.program.show().items()}


def test_a_part_is_carried_to_the_exit_and_looked_at(belt: Device) -> None:
    line = Line(belt)
    line.tell("load")
    assert line.after(0.5).state is MotionState.MOVING
    assert line.after(1.0).fact("part_at") == "entry"
    line.tell("gate", to="open")
    line.tell("advance", to="exit", speed_mm_s=200)
    assert line.after(0.5).fact("mm_s") == 200
    report = line.after(1.5)
    assert (report.done, report.state, report.fact("part_at")) == ("c1", MotionState.STOPPED, "exit")
    line.tell("scan")
    assert line.after(0.1).answered is None
    assert (line.after(0.5).answered, line.after(0.1).answer) == ("c1", "good")


def test_a_latch_ends_work_and_refuses_more_until_it_is_cleared(belt: Device) -> None:
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
    line.program.beat(0)  # nobody yet
    line.tell("load")
    assert line.after(2.5).state is MotionState.MOVING
    line.program.beat(1)
    assert line.after(1.9).state is MotionState.MOVING
    assert line.after(0.5).state is MotionState.STOPPED


@pytest.mark.parametrize("given", [[], [1, 2], ["1"], [1.0]])
def test_other_arguments_than_its_own_are_refused(belt: Device, given: list[object]) -> None:
    line = Line(belt)
    assert line.program.call("Load", given) == "BadInvalidArgument"
    assert line.after(0.2).state is MotionState.STOPPED


@pytest.mark.parametrize(
    ("fault", "why"),
    [("null", "is None"), ("text", "is 'exit'"), ("nonsense", "is 77"), ("frozen", "alive is")],
)
def test_what_cannot_be_believed_is_no_report(belt: Device, fault: str, why: str) -> None:
    line = Line(belt)
    line.after(0.2)
    line.faults.switch(fault, on=True)
    with pytest.raises(UnreadableValue, match=why):
        line.after(2.0)


def test_faults_of_the_server(belt: Device) -> None:
    line = Line(belt, "refuses_calls", "bad_status", "mute")
    assert line.tell("load") == "BadUserAccessDenied"
    assert line.program.show()["part_at"] == Bad(status="BadSensorFailure")
    assert line.program.is_mute()
