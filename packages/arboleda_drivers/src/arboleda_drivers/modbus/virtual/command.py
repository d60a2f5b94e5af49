"""`arboleda virtual modbus`."""

from __future__ import annotations

import time
from functools import partial
from typing import Annotated

import typer

from arboleda_drivers.plc.virtual.server import PlcServer
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .memory import FAULTS, BeltMemory

HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over Modbus TCP, or over RTU with --serial; "
    "examples/plc_conveyor speaks to it. Its registers are in docs/how-to/modbus.md.",
    FAULTS,
)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free one.")] = 5020,
    serial: Annotated[
        str, typer.Option(help="A serial line, as /dev/ttyUSB0, at 19200 baud without parity.")
    ] = "",
    fault: FaultNames = None,
    fault_port: FaultPort = 4714,
) -> None:
    # They load asyncio, which no other command needs.
    from arboleda_drivers.modbus.adapter import need_library
    from arboleda_drivers.modbus.server import ModbusServer

    def plc(faults: Faults) -> PlcServer:
        memory = BeltMemory(faults, time.monotonic, tcp=not serial)
        make = partial(ModbusServer, memory, host=host, port=port, serial=serial, trace=memory.trace)
        return PlcServer(f"Modbus on {serial or host}", need_library, make)

    serve(plc, FAULTS, fault, fault_port)


add_to = adding("modbus", HELP, run)
