"""Ports of a virtual controller of Universal Robots: dashboard, RTDE and the primary client interface."""

from __future__ import annotations

from collections.abc import Collection

from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE
from arboleda_drivers.virtual.tcp_server import TcpServer

from .machine import ClientData, Disconnect, Drop, Event, Joined, Message, VirtualUr


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
