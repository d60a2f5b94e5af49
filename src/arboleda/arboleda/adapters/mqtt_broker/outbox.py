"""Messages and answers on their way to a client of the broker."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from . import limits, packets
from .packets import Message

LAST_ID = 65535


class Outbox:
    """Packets for a client, which leave when `flush` is called; once it is `over`, none does.

    A client that leaves too many bytes unread, or too many messages unacknowledged, is `cut` off.
    """

    def __init__(self, transport: asyncio.Transport, cut: Callable[[str], None]) -> None:
        self.over = False
        self.waiting_bytes = 0
        self._transport = transport
        self._cut = cut
        self._waiting: list[bytes] = []
        self._last_id = 0
        self._unacknowledged: set[int] = set()

    def send(self, message: Message) -> None:
        """Queue a message."""
        number = self._next_id() if message.qos else 0
        self.write(packets.publish(message, number))

    def write(self, data: bytes) -> None:
        """Queue the bytes of a packet."""
        self._waiting.append(data)
        self.waiting_bytes += len(data)
        if self.waiting_bytes + self._transport.get_write_buffer_size() > limits.UNSENT_BYTES:
            self._cut(f"it leaves {limits.UNSENT_BYTES} bytes unread")

    def flush(self) -> None:
        """Hand over the queued bytes to the system."""
        out, self._waiting, self.waiting_bytes = b"".join(self._waiting), [], 0
        if out and not self.over:
            self._transport.write(out)

    def acknowledged(self, number: int) -> None:
        """Note that the client has a message of QoS 1."""
        self._unacknowledged.discard(number)

    def _next_id(self) -> int:
        if len(self._unacknowledged) >= limits.UNACKNOWLEDGED:
            self._cut(f"it leaves {limits.UNACKNOWLEDGED} messages unacknowledged")
        while True:
            self._last_id = self._last_id % LAST_ID + 1
            if self._last_id not in self._unacknowledged:
                break
        self._unacknowledged.add(self._last_id)
        return self._last_id
