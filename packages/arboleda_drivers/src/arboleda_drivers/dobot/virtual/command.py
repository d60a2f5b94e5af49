"""The command `arboleda virtual dobot`."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from functools import partial
from typing import Annotated

import typer

from arboleda_drivers.virtual.serving import FaultNames, FaultPort, adding, serve, with_faults
from arboleda_drivers.virtual.tcp_server import TcpServer

from .machine import FAULTS, ClientText, Disconnect, Frame, Message, VirtualDobot

DASHBOARD, FEEDBACK = "dashboard", "feedback"
HELP = with_faults(
    "Play a Dobot CR10A with a controller of version 4: dashboard and feedback over TCP, joint moves that "
    "take their time, tool outputs. It begins disabled, as a real one does. Any client of that protocol can "
    "use it.",
    FAULTS,
)


def run(
    port: Annotated[int, typer.Option(help="Port of the dashboard; 0: any free one.")] = 29999,
    feedback_port: Annotated[int, typer.Option(help="Port of the feedback; 0: any free one.")] = 30004,
    host: Annotated[str, typer.Option(help="The address that it listens on.")] = "127.0.0.1",
    enabled: Annotated[bool, typer.Option("--enabled", help="Begin enabled, ready to move.")] = False,
    fault: FaultNames = None,
    fault_port: FaultPort = 4713,
) -> None:
    make = partial(Server, host=host, port=port, feedback_port=feedback_port, enabled=enabled)
    serve(make, FAULTS, fault, fault_port)


add_to = adding("dobot", HELP, run)


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
