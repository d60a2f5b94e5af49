"""`arboleda virtual modbus`."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, serve, with_faults

from .memory import FAULTS

NAME = "modbus"
HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over Modbus TCP, or over RTU with --serial; "
    "examples/plc_conveyor speaks to it. Its registers are in docs/how-to/modbus.md.",
    FAULTS,
)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(NAME, help=HELP)(run)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free one.")] = 5020,
    serial: Annotated[
        str, typer.Option(help="A serial line, as /dev/ttyUSB0, at 19200 baud without parity.")
    ] = "",
    fault: FaultNames = None,
    fault_port: FaultPort = 4714,
) -> None:
    from .server import Server  # it loads asyncio, which no other command needs

    serve(lambda faults: Server(faults, host=host, port=port, serial=serial), FAULTS, fault, fault_port)
