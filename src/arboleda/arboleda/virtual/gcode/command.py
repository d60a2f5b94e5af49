"""The command `arboleda virtual gcode`."""

from __future__ import annotations

from enum import Enum
from typing import Annotated

import typer

from ..faults import Faults
from ..pty_line import PtyLine
from ..serving import FaultNames, FaultPort, serve, with_faults
from .faults import GRBL_FAULTS, MARLIN_FAULTS
from .grbl import VirtualGrbl
from .marlin import VirtualMarlin

NAME = "gcode"
HELP = with_faults(
    with_faults(
        "Play a machine of three axes whose controller runs GRBL 1.1 or Marlin, on a pseudo terminal: moves "
        "that take their time, stops, homing, alarms, a door. It begins not homed, as a real one does. Any "
        "sender of G-code can use it.",
        GRBL_FAULTS,
        "Faults with GRBL",
    ),
    MARLIN_FAULTS,
    "Faults with Marlin",
)


class Dialect(str, Enum):
    """Firmware of the controller, as the plant file calls it."""

    GRBL = "grbl"
    MARLIN = "marlin"


def run(
    dialect: Annotated[Dialect, typer.Option(help="What its controller runs.")] = Dialect.GRBL,
    link: Annotated[
        str, typer.Option(help="Name of the line, a link to its pseudo terminal; by default of the dialect.")
    ] = "",
    homed: Annotated[
        bool, typer.Option("--homed", help="Begin homed, ready to move; with GRBL only.")
    ] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4727,
) -> None:
    if dialect is Dialect.MARLIN and homed:
        raise typer.BadParameter(
            "a machine with Marlin does not tell whether it is homed", param_hint="--homed"
        )

    def line(faults: Faults) -> PtyLine:
        machine = VirtualMarlin(faults) if dialect is Dialect.MARLIN else VirtualGrbl(faults, homed=homed)
        name = {Dialect.GRBL: "GRBL", Dialect.MARLIN: "Marlin"}[dialect]
        return PtyLine(
            machine, link=link or f"/tmp/arboleda-{dialect.value}", what=f"a virtual machine with {name}"
        )

    known = MARLIN_FAULTS if dialect is Dialect.MARLIN else GRBL_FAULTS
    serve(line, known, fault, fault_port)
