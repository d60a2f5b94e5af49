"""The command `arboleda virtual dobot`."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, serve, with_faults

from .faults import FAULTS
from .sockets import Server

NAME = "dobot"
HELP = with_faults(
    "Play a Dobot CR10A with a controller of version 4: dashboard and feedback over TCP, joint moves that "
    "take their time, tool outputs. It begins disabled, as a real one does. Any client of that protocol can "
    "use it.",
    FAULTS,
)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(NAME, help=HELP)(run)


def run(
    port: Annotated[int, typer.Option(help="Port of the dashboard; 0: any free one.")] = 29999,
    feedback_port: Annotated[int, typer.Option(help="Port of the feedback; 0: any free one.")] = 30004,
    host: Annotated[str, typer.Option(help="The address that it listens on.")] = "127.0.0.1",
    enabled: Annotated[bool, typer.Option("--enabled", help="Begin enabled, ready to move.")] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4713,
) -> None:
    serve(
        lambda faults: Server(faults, host=host, port=port, feedback_port=feedback_port, enabled=enabled),
        FAULTS,
        fault,
        fault_port,
    )
