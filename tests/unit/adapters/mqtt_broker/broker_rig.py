"""The plant's own broker without a network: its clients are lines in memory, time is moved by hand."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.adapters.mqtt_broker import packets, sessions
from arboleda.adapters.mqtt_broker.access import Access
from arboleda.adapters.mqtt_broker.client import Client
from arboleda.adapters.mqtt_broker.packets import Kind, Message
from arboleda.adapters.mqtt_broker.router import Router
from arboleda.adapters.mqtt_broker.sessions import Sessions

Login = tuple[str, str]
PLANT = ("arboleda", "secret")
USERS = {"ra_1": "one", "ra_2": "two", "ana": "look"}
BOARDS = frozenset({"ra_1", "ra_2"})


def text(value: str | bytes) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return struct.pack("!H", len(raw)) + raw


def packet(kind: int, body: bytes) -> bytes:
    """A packet with a length of two bytes."""
    return bytes((kind, len(body) & 127 | 128, len(body) >> 7)) + body


def published(
    topic: str, payload: bytes = b"x", *, qos: int = 0, retain: bool = False, number: int = 1
) -> bytes:
    return packets.publish(Message(topic=topic, payload=payload, qos=qos, retain=retain), number)


def subscription(*filters: str) -> bytes:
    return packet(0x82, b"\0\1" + b"".join(text(each) + b"\1" for each in filters))


class Time:
    """What the broker sees of an event loop."""

    def __init__(self) -> None:
        self._now = 100.0
        self._timers: list[tuple[float, SimpleNamespace]] = []

    def time(self) -> float:
        return self._now

    def call_later(self, delay: float, call: Callable[..., None], *args: Any) -> SimpleNamespace:
        timer = SimpleNamespace(call=lambda: call(*args), cancel=lambda: self._cancel(timer))
        self._timers.append((self._now + delay, timer))
        return timer

    def _cancel(self, timer: SimpleNamespace) -> None:
        self._timers = [pair for pair in self._timers if pair[1] is not timer]

    def passes(self, seconds: float) -> None:
        until = self._now + seconds
        while due := [pair for pair in self._timers if pair[0] <= until]:
            at, timer = min(due, key=lambda pair: pair[0])
            self._cancel(timer)
            self._now = max(self._now, at)
            timer.call()
        self._now = until


class Line(asyncio.Transport):
    """The broker's end of a connection. A peer that is `deaf` takes nothing out of its buffer."""

    def __init__(self) -> None:
        super().__init__()
        self.written = bytearray()
        self.is_over = self.is_deaf = False

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        return SimpleNamespace(setsockopt=lambda *_: None) if name == "socket" else default

    def write(self, data: bytes | bytearray | memoryview) -> None:
        self.written += data

    def get_write_buffer_size(self) -> int:
        return len(self.written) if self.is_deaf else 0

    def abort(self) -> None:
        self.is_over = True

    def close(self) -> None:
        self.is_over = True

    def pause_reading(self) -> None:
        """The broker keeps what it was given."""

    def resume_reading(self) -> None:
        """There is nothing that waits."""


class Peer:
    """A client at the other end of a line."""

    def __init__(self, client: Client) -> None:
        self.line = Line()
        self._client = client
        client.connection_made(self.line)

    def say(self, data: bytes) -> None:
        """Send bytes, in pieces as a socket brings them."""
        while data:
            room = self._client.get_buffer(-1)
            piece, data = data[: len(room)], data[len(room) :]
            room[: len(piece)] = piece
            self._client.buffer_updated(len(piece))

    def heard(self) -> list[packets.Packet]:
        """The packets that came since the last time, without their bytes in the line."""
        stream = packets.Stream()
        stream.feed(bytes(self.line.written))
        self.line.written.clear()
        return list(iter(stream.next, None))

    def messages(self) -> list[Message]:
        return [packets.read_publish(each)[0] for each in self.heard() if each.kind is Kind.PUBLISH]

    def granted(self, *filters: str) -> list[bool]:
        """Subscribe; which of the filters were granted."""
        self.say(subscription(*filters))
        (answer,) = [each for each in self.heard() if each.kind is Kind.SUBACK]
        return [qos != packets.FAILED for qos in answer.body[2:]]


class Broker:
    """A broker, with users unless it is for guests."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *, guests: bool = False, most: int = 1000) -> None:
        self.time = Time()
        monkeypatch.setattr(asyncio, "get_running_loop", lambda: self.time)
        monkeypatch.setattr(sessions, "get_running_loop", lambda: self.time)
        access = Access(plant=PLANT, passwords={} if guests else USERS, boards=BOARDS, guests=guests)
        self._sessions, self._router = Sessions(access, most), Router(access)

    def dialled(self) -> Peer:
        """One that has connected, and said nothing yet."""
        return Peer(Client(self._sessions, self._router))

    def asked(
        self, id: str, login: Login | None = None, *, will: str = "", keep_alive_s: int = 0
    ) -> tuple[Peer, int]:
        """One that has asked to be let in, and the code of the answer."""
        flags, rest = 0x02, text(id)
        if will:
            flags |= 0x2C
            rest += text(will) + text("0")
        if login is not None:
            flags |= 0xC0
            rest += text(login[0]) + text(login[1])
        made = self.dialled()
        made.say(packet(0x10, text("MQTT") + bytes((4, flags)) + struct.pack("!H", keep_alive_s) + rest))
        self.time.passes(1.0)  # a refusal comes after a pause
        (answer,) = made.heard()
        return made, answer.body[1]

    def peer(self, id: str, login: Login | None = None, *filters: str, **how: Any) -> Peer:
        """One that was let in, with its subscriptions."""
        made, answer = self.asked(id, login, **how)
        assert answer == packets.Answer.ACCEPTED
        if filters:
            assert all(made.granted(*filters))
        return made
