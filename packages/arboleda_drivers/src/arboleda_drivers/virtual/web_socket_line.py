"""Line of a virtual device that is a websocket: each line is a message, and the last client has it."""

from __future__ import annotations

from collections.abc import Sequence

from websockets.frames import Frame, Opcode
from websockets.http11 import Request
from websockets.protocol import State
from websockets.server import ServerProtocol

from .pty_line import LineMachine
from .tcp_server import TcpServer

Chunk = tuple[int, bytes]  # of a client


class _LineEnd:
    """Machine at the far end of the line, as a server takes one."""

    def __init__(self, machine: LineMachine) -> None:
        self._machine = machine
        self.client = 0  # the last one

    @property
    def next_deadline(self) -> float:
        return self._machine.next_deadline

    @property
    def is_off(self) -> bool:
        return self._machine.is_unplugged

    def step(self, now: float, events: Sequence[Chunk]) -> Sequence[Chunk]:
        data = b"".join(chunk for client, chunk in events if client == self.client)
        return [(self.client, self._machine.step(now, data))]


class WebSocketLine(TcpServer):
    """Websocket before a machine until `stop`; while that is unplugged nobody is let in."""

    def __init__(
        self, machine: LineMachine, *, host: str = "127.0.0.1", port: int = 0, what: str = "a virtual device"
    ) -> None:
        self.machine, self._what = machine, what
        self._end = _LineEnd(machine)
        super().__init__(self._end, kind="websocket", host=host, ports={"websocket": port})
        self._protocols: dict[int, ServerProtocol] = {}

    @property
    def port(self) -> int:
        return int(self.ports["websocket"])

    @property
    def says(self) -> str:
        return f"{self._what} is at ws://{self._host}:{self.port}/websocket"

    def _joined(self, client: int, port: str) -> list[Chunk]:
        if self._end.client:
            self._drop(self._end.client)
        self._end.client = client
        self._protocols = {client: ServerProtocol()}
        return []

    def _events_of(self, client: int, port: str, data: bytes) -> list[Chunk]:
        protocol = self._protocols.get(client)
        if protocol is None or not data:
            return []
        protocol.receive_data(data)
        lines = b""
        for event in protocol.events_received():
            if isinstance(event, Request):
                protocol.send_response(protocol.accept(event))
            elif isinstance(event, Frame) and event.opcode in (Opcode.TEXT, Opcode.BINARY, Opcode.CONT):
                lines += bytes(event.data).replace(b"\n", b" ") + (b"\n" if event.fin else b"")
        self._flush(client, protocol)
        return [(client, lines)]

    def _do(self, message: Chunk) -> None:
        client, data = message
        if self._end.is_off:
            self._hang_up()
            return
        protocol = self._protocols.get(client)
        if protocol is not None and protocol.state is State.OPEN and data:
            for line in data.splitlines():
                protocol.send_text(line)
            self._flush(client, protocol)

    def _flush(self, client: int, protocol: ServerProtocol) -> None:
        for data in protocol.data_to_send():
            self._send(client, data)
