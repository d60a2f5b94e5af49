"""`arboleda virtual modbus`."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from arboleda.adapters.modbus import need_library
from arboleda.adapters.modbus_server import ModbusServer
from arboleda.drivers.port import DriverError
from arboleda.model.errors import StartError

from ..faults import Faults
from ..serving import FaultNames, FaultPort, serve, with_faults
from .memory import FAULTS, BeltMemory

HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over Modbus TCP, or over RTU with --serial; "
    "examples/plc_conveyor speaks to it. Its registers are in docs/how-to/modbus.md.",
    FAULTS,
)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free.")] = 5020,
    serial: Annotated[
        str, typer.Option(help="A serial line, as /dev/ttyUSB0, at 19200 baud without parity.")
    ] = "",
    fault: FaultNames = None,
    fault_port: FaultPort = 4714,
) -> None:
    serve(lambda faults: Plc(faults, host=host, port=port, serial=serial), FAULTS, fault, fault_port)


class Plc:
    """The belt, listening from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0, serial: str = "") -> None:
        self._where = serial or host
        memory = BeltMemory(faults, time.monotonic, tcp=not serial)
        self._server = ModbusServer(memory, host=host, port=port, serial=serial, trace=memory.trace)
        self.port = 0

    @property
    def says(self) -> str:
        where = f"{self._where}:{self.port}" if self.port else self._where
        return f"the virtual PLC speaks Modbus on {where}"

    def start(self) -> None:
        """StartError where pymodbus is missing, or nothing can listen there."""
        try:
            need_library()
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        self._server.stop()
