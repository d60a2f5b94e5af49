"""The command `arboleda virtual ur`."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial
from typing import Annotated

import typer

from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE
from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults
from arboleda_drivers.virtual.tcp_server import TcpServer

from .faults import FAULTS
from .machine import ClientData, Disconnect, Drop, Event, Joined, Message, VirtualUr

HELP = with_faults(
    "Play the controller of an arm of Universal Robots, PolyScope 5: dashboard, RTDE, and programs of joint "
    "moves, stops and outputs over the primary client interface. It begins without power, as a real one "
    "does. Any client of dashboard and RTDE can use it.",
    FAULTS,
)


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
    ports = partial(Server, port=port, rtde_port=rtde_port, script_port=script_port)
    serve(partial(ports, host=host, running=running), FAULTS, fault, fault_port)


add_to = adding("ur", HELP, run)


class Server(TcpServer):
    """Server on all three ports that plays the controller until `stop`; port 0 takes a free one."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        rtde_port: int = 0,
        script_port: int = 0,
        running: bool = False,
    ) -> None:
        self.machine = VirtualUr(faults, running=running)
        ports = {DASHBOARD: port, RTDE: rtde_port, PRIMARY: script_port}
        super().__init__(self.machine, kind="ur", host=host, ports=ports)

    @property
    def says(self) -> str:
        ports = f"dashboard {self.ports[DASHBOARD]}, RTDE {self.ports[RTDE]}, programs {self.ports[PRIMARY]}"
        return f"a virtual arm of Universal Robots listens on {self._host}: {ports}"

    def _joined(self, client: int, port: str) -> list[Event]:
        return [Joined(client=client, port=port)]

    def _events_of(self, client: int, port: str, data: bytes) -> list[Event]:
        return [ClientData(client=client, port=port, data=data)]

    def _do(self, message: Message) -> None:
        if isinstance(message, Disconnect):
            self._hang_up()
        elif isinstance(message, Drop):
            self._drop(message.client)
        else:
            self._send(message.client, message.data)
