"""The command `arboleda virtual gcode`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..pty_line import PtyLine
from ..serving import FaultNames, FaultPort, serve, with_faults
from .faults import FAULTS
from .machine import VirtualGrbl

NAME = "gcode"
HELP = with_faults(
    "Play a machine of three axes whose controller runs GRBL 1.1, on a pseudo terminal: moves that take "
    "their time, feed hold, reset, homing, alarms, a door. It begins locked, as a real one with homing does. "
    "Any sender of G-code can use it.",
    FAULTS,
)


def run(
    link: Annotated[
        str, typer.Option(help="Name of the line: a link to its pseudo terminal.")
    ] = "/tmp/arboleda-grbl",
    homed: Annotated[bool, typer.Option("--homed", help="Begin homed, ready to move.")] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4727,
) -> None:
    serve(
        lambda faults: PtyLine(
            VirtualGrbl(faults, homed=homed), link=link, what="a virtual machine with GRBL"
        ),
        FAULTS,
        fault,
        fault_port,
    )
