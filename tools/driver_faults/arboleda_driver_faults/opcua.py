"""Campaign of the belt behind OPC UA under faults: the driver's machine at variables and methods."""

from __future__ import annotations

from arboleda.drivers import Report
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda_drivers.opcua.machine import Call, OpcUaDevice, Read
from arboleda_drivers.opcua.server import Bad
from arboleda_drivers.opcua.settings import Settings
from arboleda_drivers.opcua.virtual.command import FAULTS
from arboleda_drivers.opcua.virtual.program import BeltProgram

from .plc import NO_LINK, BeltRig, LineBroken
from .rig import Causes

CAUSES: Causes = {
    "mute": NO_LINK,
    "refuses_calls": {Reason.REJECTED, *NO_LINK},
    "bad_status": NO_LINK,
    "null": NO_LINK,
    "text": NO_LINK,
}


class OpcUaRig(BeltRig):
    """Test with the example's belt, and the variables of its virtual PLC."""

    driver = "opcua"

    def __init__(self, example: PlantModel) -> None:
        super().__init__(example, FAULTS, CAUSES)
        self._program = BeltProgram(self.faults, lambda: self.now, belt=self.belt)
        self._late: list[Call] = []  # calls to a mute server, which it carries out afterwards

    def wire(self) -> Variables:
        assert self.device.driver is not None and isinstance(self.device.driver.settings, Settings)
        machine = OpcUaDevice(self.device, self.device.driver.settings)
        return Variables(machine, self._program, self._late)


class Variables:
    """Reads and calls of the driver's machine; a mute server carries out its calls late."""

    def __init__(self, machine: OpcUaDevice, program: BeltProgram, late: list[Call]) -> None:
        self._machine, self._program, self._late = machine, program, late

    def begin(self) -> None:
        self._machine.begin(self._read())

    def order(self, command: Command) -> str | None:
        call = self._machine.order(command)
        if call is None:
            return None
        assert isinstance(call, Call)  # the belt of the example writes no variables
        if self._program.is_mute():
            self._late.append(call)
        self._answer()
        refused = self._call(call)
        if refused is not None and isinstance(command, Stop):
            raise LineBroken(f"{call.method} was refused: {refused}")
        return refused

    def beat(self, number: int) -> None:
        self._answer()
        self._program.beat(number)

    def report(self, at: float) -> Report:
        return self._machine.report(at, self._read())

    def _read(self) -> Read:
        self._answer()
        read = {f"ns=2;s={name}": value for name, value in self._program.show().items()}
        for node, value in read.items():
            if isinstance(value, Bad):
                raise LineBroken(f"{node} is {value.status}")
        return read

    def _call(self, call: Call) -> str | None:
        return self._program.call(call.method.removeprefix("ns=2;s="), [value for _, value in call.given])

    def _answer(self) -> None:
        """Answer the calls that wait, before any new one; raises LineBroken while the server is mute."""
        if self._program.is_mute():
            raise LineBroken("the server does not answer")
        while self._late:
            self._call(self._late.pop(0))
