"""The command `arboleda virtual vda5050`."""

from __future__ import annotations

from enum import Enum
from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults

from .faults import FAULTS


class Version(str, Enum):
    """Version of VDA 5050 that the vehicle speaks."""

    V2_0 = "2.0"
    V2_1 = "2.1"
    V3_0 = "3.0"


HELP = with_faults(
    "Play a mobile robot that speaks VDA 5050 over MQTT: orders and their updates, actions pick, drop, "
    "startCharging, stopCharging, detectObject and any other at nodes and on edges, instant actions, a "
    "factsheet. It brings a broker unless --broker names one. Any master control can use it.",
    FAULTS,
)


def run(
    manufacturer: Annotated[str, typer.Option(help="Its manufacturer, as in its topics.")] = "arboleda",
    serial: Annotated[str, typer.Option(help="Its serial number, as in its topics.")] = "agv1",
    version: Annotated[Version, typer.Option(help="Version of VDA 5050.")] = Version.V2_1,
    interface: Annotated[str, typer.Option(help="What its topics begin with.")] = "uagv",
    node: Annotated[str, typer.Option(help="The node that it stands on at first.")] = "0",
    speed: Annotated[float, typer.Option(help="Speed, m/s; an edge without positions takes a second.")] = 0.5,
    state_s: Annotated[float, typer.Option(help="A state at least so often, s.")] = 1.0,
    broker: Annotated[
        str | None, typer.Option(metavar="HOST:PORT", help="A broker that is there, mqtts:// for TLS.")
    ] = None,
    port: Annotated[int, typer.Option(help="Port of the broker that it brings; 0: any free one.")] = 1884,
    fault: FaultNames = None,
    fault_port: FaultPort = 4715,
) -> None:
    from .broker import Server  # it loads a library of MQTT

    serve(
        lambda faults: Server(
            faults,
            manufacturer=manufacturer,
            serial=serial,
            version=version.value,
            interface=interface,
            broker=broker,
            port=port,
            node=node,
            speed=speed,
            state_s=state_s,
        ),
        FAULTS,
        fault,
        fault_port,
    )


add_to = adding("vda5050", HELP, run)
