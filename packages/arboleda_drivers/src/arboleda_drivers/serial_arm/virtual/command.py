"""The command `arboleda virtual serial_arm`."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

from arboleda_drivers.virtual.pty_line import PtyLine
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .faults import FAULTS
from .machine import VirtualServos

HELP = with_faults(
    "Play an arm of six bus servos, the last of which is its gripper, on a pseudo terminal: the registers, "
    "packets and motion of Feetech's STS series or of Dynamixel's X series. It begins without torque, as a "
    "real one does. Any client of these protocols can use it.",
    FAULTS,
)
Link = Annotated[str, typer.Option(help="Name of the line: a link to its pseudo terminal.")]


def run(
    link: Link = "/tmp/arboleda-arm",
    protocol: Annotated[Literal["feetech", "dynamixel"], typer.Option(help="Of the servos.")] = "feetech",
    torque: Annotated[bool, typer.Option("--torque", help="Begin with torque, ready to move.")] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4726,
) -> None:
    serve(
        lambda faults: PtyLine(
            VirtualServos(faults, maker=protocol, torque=torque),
            link=link,
            what=f"a virtual arm of {protocol} servos",
        ),
        FAULTS,
        fault,
        fault_port,
    )


add_to = adding("serial_arm", HELP, run)
