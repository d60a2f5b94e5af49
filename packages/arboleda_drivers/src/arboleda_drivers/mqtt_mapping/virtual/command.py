"""The command `arboleda virtual mqtt`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .machine import FAULTS

HELP = with_faults(
    "Play the devices of a plant file that are mapped by their topics: they take what the plant sends, and "
    "say what it hears. Their broker is the one of the plant file; it is started, unless --broker-is-there.",
    FAULTS,
)


def run(
    plant: Annotated[Path, typer.Argument(metavar="FILE", help="The plant file.")],
    broker_is_there: Annotated[
        bool, typer.Option("--broker-is-there", help="Go to the broker, and start none.")
    ] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4728,
) -> None:
    from arboleda.extension import load

    from .server import Server  # it loads a library of MQTT

    devices = [*load(plant).robots.values()]
    serve(lambda faults: Server(devices, faults, is_there=broker_is_there), FAULTS, fault, fault_port)


add_to = adding("mqtt", HELP, run)
