"""`arboleda virtual s7`."""

from __future__ import annotations

from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .memory import FAULTS

HELP = with_faults(
    "Play a Siemens S7 with a belt, a gate and an eye; examples/plc_conveyor/s7.yaml speaks to it. "
    "Its data blocks are in docs/how-to/s7.md.",
    FAULTS,
)


def run(
    host: Annotated[str, typer.Option(help="Where to listen, an IPv4 address.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Its port; 0: any free. That of a real one is 102.")] = 1102,
    fault: FaultNames = None,
    fault_port: FaultPort = 4724,
) -> None:
    from .server import Server  # it loads python-snap7, which no other command needs

    serve(lambda faults: Server(faults, host=host, port=port), FAULTS, fault, fault_port)


add_to = adding("s7", HELP, run)
