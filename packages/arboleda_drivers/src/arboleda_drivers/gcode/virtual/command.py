"""The command `arboleda virtual gcode`."""

from __future__ import annotations

from enum import Enum
from typing import Annotated

import typer

from arboleda.extension import Phrase, say
from arboleda_drivers.virtual.faults import Faults
from arboleda_drivers.virtual.pty_line import PtyLine
from arboleda_drivers.virtual.serving import Controller, FaultNames, FaultPort, adding, serve, with_faults

from .faults import GRBL_FAULTS, MARLIN_FAULTS, MOONRAKER_FAULTS
from .grbl import VirtualGrbl
from .marlin import VirtualMarlin
from .moonraker import VirtualMoonraker

MOONRAKER = "a virtual machine with Klipper, behind Moonraker,"
NOT_TOLD = Phrase("cli.virtual.not_told", "a machine with Marlin does not tell whether it is homed")
AT_A_PORT = Phrase("cli.virtual.at_a_port", "a machine with Moonraker begins not homed, at a port")
OF_LINES = "--homed, --link"
HELP = with_faults(
    with_faults(
        with_faults(
            "Play a machine of three axes whose controller runs GRBL 1.1 or Marlin, on a pseudo terminal, or "
            "Klipper, behind a port of Moonraker: moves that take their time, stops, homing, alarms, a door. "
            "It begins not homed, as a real one does. Any sender of G-code can use it.",
            GRBL_FAULTS,
            "Faults with GRBL",
        ),
        MARLIN_FAULTS,
        "Faults with Marlin",
    ),
    MOONRAKER_FAULTS,
    "Faults with Moonraker",
)
FAULTS = {"grbl": GRBL_FAULTS, "marlin": MARLIN_FAULTS, "moonraker": MOONRAKER_FAULTS}


class Dialect(str, Enum):
    """Firmware of the controller, as the plant file calls it."""

    GRBL = "grbl"
    MARLIN = "marlin"
    MOONRAKER = "moonraker"


def run(
    dialect: Annotated[Dialect, typer.Option(help="What its controller runs.")] = Dialect.GRBL,
    link: Annotated[
        str, typer.Option(help="Name of the line, a link to its pseudo terminal; by default of the dialect.")
    ] = "",
    port: Annotated[int, typer.Option(help="Port with Moonraker; 0: any free one.")] = 7125,
    host: Annotated[str, typer.Option(help="The address that it listens on.")] = "127.0.0.1",
    homed: Annotated[
        bool, typer.Option("--homed", help="Begin homed, ready to move; with GRBL only.")
    ] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4727,
) -> None:
    if dialect is Dialect.MARLIN and homed:
        raise typer.BadParameter(say(NOT_TOLD()), param_hint="--homed")
    if dialect is Dialect.MOONRAKER and (homed or link):
        raise typer.BadParameter(say(AT_A_PORT()), param_hint=OF_LINES)

    def line(faults: Faults) -> Controller:
        if dialect is Dialect.MOONRAKER:
            from arboleda_drivers.virtual.web_socket_line import (
                WebSocketLine,  # websockets take a while to load
            )

            return WebSocketLine(VirtualMoonraker(faults), host=host, port=port, what=MOONRAKER)
        machine = VirtualMarlin(faults) if dialect is Dialect.MARLIN else VirtualGrbl(faults, homed=homed)
        name = {Dialect.GRBL: "GRBL", Dialect.MARLIN: "Marlin"}[dialect]
        return PtyLine(
            machine, link=link or f"/tmp/arboleda-{dialect.value}", what=f"a virtual machine with {name}"
        )

    serve(line, FAULTS[dialect.value], fault, fault_port)


add_to = adding("gcode", HELP, run)
