"""The belt of the example behind each protocol of PLCs, as a row of data; its driver at the virtual PLC."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import pytest
from tests.packages import ROOT

from arboleda.drivers import Report
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command
from arboleda.plant_file.loader import load
from arboleda_driver_faults.modbus import ModbusRig
from arboleda_driver_faults.opcua import OpcUaRig
from arboleda_driver_faults.plc import BeltRig
from arboleda_driver_faults.s7 import S7Rig
from arboleda_drivers.modbus.machine import ModbusDevice
from arboleda_drivers.modbus.settings import Settings as ModbusSettings
from arboleda_drivers.opcua.machine import OpcUaDevice
from arboleda_drivers.opcua.settings import Settings as OpcUaSettings
from arboleda_drivers.s7.machine import S7Device
from arboleda_drivers.s7.settings import Settings as S7Settings

EXAMPLE = ROOT / "examples/plc_conveyor"
ECHO = ("done", "rejected", "failed", "accepted", "reason", "failure", "boot", "alive", "state", "part_at")
INPUTS = ("boot", "alive", "state", "accepted", "done", "rejected", "reason", "failed", "failure")
NODES = (*INPUTS, "part_at", "gate", "mm_s", "seen")


@dataclass(frozen=True, kw_only=True)
class Plc:
    """`at`: where the PLC shows each value; `held`: where all are that its driver's machine reads."""

    file: str
    settings: type
    rig: Callable[..., BeltRig]
    machine: Callable[..., Any]
    at: Mapping[str, str]
    held: Callable[[Any], Iterable[Any]]
    key: Callable[[str], object] = str

    @property
    def device(self) -> Device:
        (robot,) = _model(self.file).robots.values()
        assert isinstance(robot, Device)
        return robot

    def made(self, **changes: object) -> Any:
        """The driver's machine of the belt, connected to a PLC that shows nothing but zeros."""
        assert self.device.driver is not None
        settings: Any = self.device.driver.settings
        made = self.machine(self.device, replace(settings, **changes))
        made.begin(self.shown(made))
        return made

    def shown(self, machine: Any, **values: object) -> dict[object, object]:
        """Values that the PLC shows: all 0, except these."""
        given = {self.key(self.at[name]): value for name, value in values.items()}
        return dict.fromkeys(self.held(machine), 0) | given

    def told(self, verb: str, **values: object) -> Command:
        return self.device.kind.command(id="c1", robot="belt", verb=verb, values=values)  # type: ignore[arg-type]


@cache
def _model(file: str) -> Any:
    return load(EXAMPLE / file)


def _register(text: str) -> tuple[str, int]:
    table, address = text.split()
    return table, int(address)


def _registers(machine: ModbusDevice) -> Iterable[tuple[str, int]]:
    return [(each.table, each.address + at) for each in machine.first_blocks for at in range(each.length)]


PLCS = {
    "modbus": Plc(
        file="plant.yaml",
        settings=ModbusSettings,
        rig=ModbusRig,
        machine=ModbusDevice,
        at={name: f"input {at}" for at, name in enumerate((*INPUTS, "", "part_at", "mm_s", "seen"))},
        held=_registers,
        key=_register,
    ),
    "opcua": Plc(
        file="opcua.yaml",
        settings=OpcUaSettings,
        rig=OpcUaRig,
        machine=OpcUaDevice,
        at={name: f"ns=2;s={name}" for name in NODES},
        held=lambda machine: machine.places,
    ),
    "s7": Plc(
        file="s7.yaml",
        settings=S7Settings,
        rig=S7Rig,
        machine=S7Device,
        at={name: f"DB1.DBW{2 * at}" for at, name in enumerate(ECHO)} | {"seen": "DB1.DBB21"},
        held=lambda machine: machine.places,
    ),
}
EACH = pytest.mark.parametrize("plc", PLCS)


class Line:
    """The driver's machine at its virtual PLC, under time moved by hand."""

    def __init__(self, plc: str, *faults: str) -> None:
        self.plc = PLCS[plc]
        self.rig = self.plc.rig(_model(self.plc.file))
        self.switch(*faults)
        self.wire: Any = self.rig.wire()
        self.wire.begin()

    def switch(self, *faults: str) -> None:
        for each in faults:
            self.rig.faults.switch(each, on=True)

    def tell(self, verb: str, **values: object) -> str | None:
        """Give an order; returns the word of a refusal by the PLC."""
        return self.send(self.plc.told(verb, **values))

    def send(self, command: Command) -> str | None:
        word: str | None = self.wire.order(command)
        return word

    def after(self, seconds: float) -> Report:
        """The report after a while, in which the PLC was read ten times a second."""
        until = self.rig.now + seconds
        while self.rig.now < until:
            self.rig.now += 0.1
            report: Report = self.wire.report(self.rig.now)
        return report
