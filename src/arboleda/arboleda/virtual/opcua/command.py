"""`arboleda virtual opcua`."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from arboleda.adapters.opcua import need_library
from arboleda.adapters.opcua_server import OpcUaServer
from arboleda.drivers.port import DriverError
from arboleda.model.errors import StartError

from ..faults import Faults
from ..serving import FaultNames, FaultPort, serve, with_faults
from .program import FAULTS, BeltProgram

HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over OPC UA, without a login; "
    "examples/plc_conveyor/opcua.yaml speaks to it. Its variables and methods are in docs/how-to/opcua.md.",
    FAULTS,
)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free.")] = 4840,
    fault: FaultNames = None,
    fault_port: FaultPort = 4716,
) -> None:
    serve(lambda faults: Plc(faults, host=host, port=port), FAULTS, fault, fault_port)


class Plc:
    """The belt, listening from `start` to `stop`."""

    def __init__(self, faults: Faults, *, host: str = "127.0.0.1", port: int = 0) -> None:
        self._host = host
        self._server = OpcUaServer(BeltProgram(faults, time.monotonic), host=host, port=port)
        self.port = 0

    @property
    def says(self) -> str:
        return f"the virtual PLC speaks OPC UA on opc.tcp://{self._host}:{self.port}"

    def start(self) -> None:
        """StartError where asyncua is missing, or nothing can listen there."""
        try:
            need_library()
            self.port = self._server.start()
        except (OSError, DriverError) as error:
            raise StartError(str(error)) from error

    def stop(self) -> None:
        self._server.stop()
