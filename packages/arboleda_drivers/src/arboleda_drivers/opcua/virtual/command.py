"""`arboleda virtual opcua`."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, serve, with_faults

from .faults import FAULTS

NAME = "opcua"
HELP = with_faults(
    "Play a PLC with a belt, a gate and an eye over OPC UA, without a login; "
    "examples/plc_conveyor/opcua.yaml speaks to it. Its variables and methods are in docs/how-to/opcua.md.",
    FAULTS,
)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(NAME, help=HELP)(run)


def run(
    host: Annotated[str, typer.Option(help="Where to listen.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free one.")] = 4840,
    fault: FaultNames = None,
    fault_port: FaultPort = 4716,
) -> None:
    from .server import Server  # it loads asyncio, which no other command needs

    serve(lambda faults: Server(faults, host=host, port=port), FAULTS, fault, fault_port)
