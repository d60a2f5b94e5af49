"""Client of RTDE: its setup, the frames that come by it, and the heartbeat to it."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from typing import Any

from . import rtde
from .port_data import RTDE, Send
from .programs import LAST_NUMBER
from .rtde import Frame, NotRtde, Packet

BEAT_S = 0.25  # period of the heartbeat, without which the controller ends our program after 1 s
BEAT = struct.Struct(">Bi")


class RtdeClient:
    """RTDE over one connection; a client that `only_listens` has no heartbeat, so it writes no register."""

    def __init__(self, out: list[Any], register: int, now: float, *, only_listens: bool) -> None:
        self._out, self._only_listens = out, only_listens
        self._wanted = rtde.outputs(register)
        self._beat = (rtde.beat_name(register), rtde.REGISTER)
        self._packets = rtde.PacketReader()
        self._recipe: int | None = None
        self._inputs: int | None = None
        self._beat_at, self._beats = now, 0

    @property
    def next_deadline(self) -> float:
        return self._beat_at + BEAT_S if self._inputs is not None else math.inf

    def greet(self) -> None:
        self._send(Packet.VERSION, struct.pack(">H", rtde.VERSION))

    def hear(self, data: bytes) -> Iterator[Frame]:
        """The frames in bytes of the controller; its answers lead through the setup."""
        for kind, payload in self._packets.feed(data):
            if kind != Packet.DATA:
                self._set_up(kind, payload)
            elif self._recipe is not None and (frame := rtde.frame_of(payload, self._recipe)) is not None:
                yield frame

    def _set_up(self, kind: int, payload: bytes) -> None:
        """Take an answer of the setup, which leads to the next request."""
        if kind == Packet.TEXT:
            return
        if not payload:
            raise NotRtde(f"its RTDE answers {chr(kind)!r} with nothing")
        if kind == Packet.VERSION:
            if payload[0] != 1:
                raise NotRtde(f"its RTDE does not speak version {rtde.VERSION}")
            names = ",".join(name for name, _ in self._wanted)
            self._send(Packet.OUTPUTS, struct.pack(">d", rtde.RATE_HZ) + names.encode())
        elif kind == Packet.OUTPUTS:
            self._recipe = rtde.recipe_of(payload, self._wanted)
            if self._only_listens:
                self._send(Packet.START)
            else:
                self._send(Packet.INPUTS, self._beat[0].encode())
        elif kind == Packet.INPUTS:
            self._inputs = rtde.recipe_of(payload, [self._beat])
            self._send(Packet.START)
        elif kind == Packet.START and payload[0] != 1:
            raise NotRtde("its RTDE does not start")

    def pass_time(self, now: float) -> None:
        if self._inputs is not None and now >= self._beat_at + BEAT_S:
            self._beat_at, self._beats = now, (self._beats + 1) % LAST_NUMBER
            self._send(Packet.DATA, BEAT.pack(self._inputs, self._beats))

    def _send(self, kind: Packet, payload: bytes = b"") -> None:
        self._out.append(Send(port=RTDE, data=rtde.packed(kind, payload)))
