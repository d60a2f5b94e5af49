"""The command `arboleda virtual ur`."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, serve, with_faults

from .faults import FAULTS
from .sockets import Server

NAME = "ur"
HELP = with_faults(
    "Play the controller of an arm of Universal Robots, PolyScope 5: dashboard, RTDE, and programs of joint "
    "moves, stops and outputs over the primary client interface. It begins without power, as a real one "
    "does. Any client of dashboard and RTDE can use it.",
    FAULTS,
)


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command(NAME, help=HELP)(run)


def run(
    port: Annotated[int, typer.Option(help="Of the dashboard; 0: any free.")] = 29999,
    rtde_port: Annotated[int, typer.Option(help="Of RTDE; 0: any free.")] = 30004,
    script_port: Annotated[int, typer.Option(help="Of programs; 0: any free.")] = 30001,
    host: Annotated[str, typer.Option(help="The address that it listens on.")] = "127.0.0.1",
    running: Annotated[
        bool, typer.Option("--running", help="Begin with power and free brakes, ready to move.")
    ] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4725,
) -> None:
    ports = {"port": port, "rtde_port": rtde_port, "script_port": script_port}
    serve(
        lambda faults: Server(faults, host=host, running=running, **ports),
        FAULTS,
        fault,
        fault_port,
    )
