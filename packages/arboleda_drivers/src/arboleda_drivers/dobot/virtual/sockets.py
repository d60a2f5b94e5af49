"""Ports of a virtual Dobot: dashboard and feedback."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection

from arboleda_drivers.virtual.tcp_server import TcpServer

from .machine import ClientText, Disconnect, Frame, Message, VirtualDobot

DASHBOARD, FEEDBACK = "dashboard", "feedback"


class Server(TcpServer):
    """Server on both ports that plays the controller until `stop`; port 0 takes a free one."""

    def __init__(
        self,
        faults: Collection[str] = (),
        *,
        host: str = "127.0.0.1",
        port: int = 0,
        feedback_port: int = 0,
        enabled: bool = False,
        make: Callable[..., VirtualDobot] = VirtualDobot,
    ) -> None:
        self.machine = make(faults, enabled=enabled, unix_s=time.time())
        super().__init__(
            self.machine, kind="dobot", host=host, ports={DASHBOARD: port, FEEDBACK: feedback_port}
        )
        self.port, self.feedback_port = self.ports[DASHBOARD], self.ports[FEEDBACK]

    @property
    def says(self) -> str:
        ports = f"dashboard {self.port}, feedback {self.feedback_port}"
        return f"a virtual Dobot CR10A listens on {self._host}: {ports}"

    def _joined(self, client: int, port: str) -> list[ClientText]:
        return []

    def _events_of(self, client: int, port: str, data: bytes) -> list[ClientText]:
        is_text = bool(data) and port == DASHBOARD
        return [ClientText(client=client, text=data.decode("utf-8", "replace"))] if is_text else []

    def _do(self, message: Message) -> None:
        if isinstance(message, Disconnect):
            self._hang_up()
        elif isinstance(message, Frame):
            for client in self._of_port(FEEDBACK):
                self._send(client, message.data)
        else:
            self._send(message.client, message.text.encode())
