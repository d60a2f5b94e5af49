"""Uplink of a board to the broker: presence, and telemetry in time."""

from __future__ import annotations

import math

from arboleda.wire.payloads import Presence, Telemetry, angles, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

PERIOD_US = 100_000
UNNUMBERED = b'"seq":0,'
STATE = b',"estado":'  # the first key after the joints


class Uplink:
    """Collects what the board publishes while it is connected; `sent` counts telemetry since boot."""

    def __init__(self, name: str) -> None:
        self.connected = False
        self.sent = 0
        self._presence = topic(name, Channel.PRESENCE)
        self._telemetry = topic(name, Channel.TELEMETRY)
        self.due_us: float = math.inf  # time of the next periodic telemetry; inf while not connected
        self._frame = (b"", b"", b"")  # the last telemetry: up to its number, the number, after it
        self._outbox: list[Publication] = []

    def take(self) -> list[Publication]:
        """The messages published since the last call, in order."""
        taken, self._outbox = self._outbox, []
        return taken

    def announce(self, now_us: int) -> None:
        """Publish the presence; telemetry follows at each tenth of a second, as for its neighbours."""
        self.due_us = (now_us // PERIOD_US + 1) * PERIOD_US if self.connected else math.inf
        if self.connected:
            presence = encode(Presence(online=True))
            self._outbox.append(Publication(topic=self._presence, payload=presence, retain=True))

    def tell(self, telemetry: Telemetry) -> None:
        """Publish telemetry; a `seq` of 0 is replaced by the next number."""
        if self.connected:
            raw = encode(telemetry)
            self._frame = (raw, b"", b"") if telemetry.seq is None else raw.partition(UNNUMBERED)
            self.tell_again()

    def tell_angles(self, q_deg: tuple[float, ...]) -> None:
        """Send the last telemetry with new joints, under the next number."""
        before, number, after = self._frame
        _, estado, rest = before.partition(STATE)
        self._frame = (angles(q_deg) + estado + rest, number, after)
        self.tell_again()

    def tell_again(self) -> None:
        """Send the last telemetry again, under the next number."""
        if not self.connected:
            return
        self.sent += 1
        before, number, after = self._frame
        payload = b'%b"seq":%d,%b' % (before, self.sent, after) if number else before
        self._outbox.append(Publication(topic=self._telemetry, payload=payload, qos=0))

    def next_period(self, now_us: int) -> None:
        """Begin the next period of telemetry; missed periods are left out, as on a blocked board."""
        self.due_us += PERIOD_US * ((now_us - self.due_us) // PERIOD_US + 1)
