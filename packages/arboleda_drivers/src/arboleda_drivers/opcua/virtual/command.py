"""`arboleda virtual opcua`."""

from __future__ import annotations

import time
from functools import partial
from typing import Annotated

import typer

from arboleda_drivers.plc.virtual.machine import FAULTS as BELT_FAULTS
from arboleda_drivers.plc.virtual.server import PlcServer
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

FAULTS = {
    "mute": "requests are not answered, and connections stay",
    "refuses_calls": "every method returns BadUserAccessDenied",
    "bad_status": "the place of the part has the status BadSensorFailure",
    "null": "the place of the part is null",
    "text": "the place of the part is text where a number should be",
    **BELT_FAULTS,
}
HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over OPC UA, without a login; "
    "examples/plc_conveyor/opcua.yaml speaks to it. Its variables and methods are in docs/how-to/opcua.md.",
    FAULTS,
)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free one.")] = 4840,
    fault: FaultNames = None,
    fault_port: FaultPort = 4716,
) -> None:
    # They load asyncio, which no other command needs.
    from arboleda_drivers.opcua.adapter import need_library
    from arboleda_drivers.opcua.server import OpcUaServer

    from .program import BeltProgram

    def plc(faults: Faults) -> PlcServer:
        make = partial(OpcUaServer, BeltProgram(faults, time.monotonic), host=host, port=port)
        return PlcServer(f"OPC UA on opc.tcp://{host}", need_library, make)

    serve(plc, FAULTS, fault, fault_port)


add_to = adding("opcua", HELP, run)
