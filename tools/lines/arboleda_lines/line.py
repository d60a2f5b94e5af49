"""Line between a driver and its device that is bad in one form for a while, in virtual time. Pure.

What passes is a message of any type; one with `data`, bytes, can be cut, joined and followed by garbage. The
line keeps the order of what passes one way, as TCP and serial lines do.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

FORMS = {
    "slow": "each answer comes late",
    "jitter": "each answer comes late by a share of its own",
    "late_once": "one answer comes late, and those after it do not wait longer",
    "doubled": "each answer comes twice",
    "cut": "each answer comes in two pieces",
    "joined": "two answers come in one packet",
    "lost": "each third answer is lost",
    "garbage": "bytes of no telegram come between the answers",
    "half_open": "nothing passes, and the connection stays",
    "reset": "the connection ends in the middle of an answer",
    "left_over": "the same, and what was left of it comes over the next connection",
    "echo": "what is sent comes back, too",
    "baud_9600": "960 bytes pass in a second, each way",
}
OF_BYTES = ("cut", "joined", "garbage", "reset", "left_over", "echo", "baud_9600")
TIMED = ("slow", "jitter", "late_once", "cut", "joined")  # forms that have a delay
BYTES_PER_S = 960.0
LOST_OF = 3
GARBAGE = b"\x00\xff~\x13"


@dataclass(frozen=True, kw_only=True)
class Form:
    """Form in which a line is bad, one of FORMS, and its delay in s where it is one of TIMED."""

    word: str
    delay_s: float = 0.0

    def __str__(self) -> str:
        return f"{self.word} {self.delay_s:g} s" if self.word in TIMED else self.word


class Cut:
    """End of the connection, which the line gives in place of an answer."""


CUT = Cut()


@dataclass
class Way:
    """Way of messages in one direction, each with the time (s) at which it arrives."""

    last_at: float = -math.inf
    due: deque[tuple[float, Any]] = field(default_factory=deque)

    def put(self, at: float, message: Any) -> None:
        self.last_at = max(at, self.last_at)
        self.due.append((self.last_at, message))

    def take(self, now: float) -> Iterator[Any]:
        while self.due and self.due[0][0] <= now:
            yield self.due.popleft()[1]

    @property
    def next_at(self) -> float:
        return self.due[0][0] if self.due else math.inf


class Line:
    """Line of one connection after the other; good until `begin`, and again after `end`."""

    def __init__(self, chance: Random) -> None:
        self.form: Form | None = None
        self._chance = chance
        self._answers, self._asks = Way(), Way()
        self._count = 0  # answers since the form began
        self._held: tuple[float, Any] | None = (
            None  # the first of two answers, which comes alone at that time
        )
        self._left: list[Any] = []  # for the next connection
        self.asked: list[tuple[float, Any]] = []  # all that the driver sent, with the times

    @property
    def next_deadline(self) -> float:
        """The time (s) at which something arrives."""
        held_until = math.inf if self._held is None else self._held[0]
        return min(self._answers.next_at, self._asks.next_at, held_until)

    def begin(self, form: Form) -> None:
        """Let the line be bad from now on."""
        self.form, self._count = form, 0

    def end(self) -> None:
        """Let the line be good again; what is on its way arrives."""
        self.form = None

    def opened(self, now: float) -> None:
        """Note that the driver has connected."""
        for message in self._left:
            self._answers.put(now, message)
        self._left = []

    def closed(self) -> None:
        """Note that the driver has hung up: it hears nothing more, and what it has sent arrives."""
        self._answers, self._held = Way(), None

    def broken(self) -> None:
        """Note that the connection is gone, with all that was on its way."""
        self.closed()
        self._asks = Way()

    def asks(self, now: float, message: Any) -> None:
        """Take what the driver sends."""
        self.asked.append((now, message))
        word = None if self.form is None else self.form.word
        if word == "half_open":
            return
        if word == "baud_9600":
            now = max(now, self._asks.last_at) + _size(message) / BYTES_PER_S
        self._asks.put(now, message)

    def echoes(self, now: float, message: Any) -> None:
        """Take what the driver sends, as the device would say it, where that comes back."""
        if self.form is not None and self.form.word == "echo":
            self._answers.put(now, message)

    def answers(self, now: float, message: Any) -> None:
        """Take what the device says."""
        if self.form is None or self.form.word != "joined":
            self._release(now)
        if self.form is None:
            self._answers.put(now, message)
            return
        self._count += 1
        for at, each in self._changed(now, self.form, message):
            self._answers.put(at, each)

    def arrived(self, now: float) -> Iterator[Any]:
        """Answers that the driver hears by now; CUT where the connection ends, after which nothing comes."""
        if self._held is not None and self._held[0] <= now:
            self._release(now)
        for message in self._answers.take(now):
            yield message
            if message is CUT:
                self.broken()
                return

    def sent(self, now: float) -> Iterator[Any]:
        """Messages that the device hears by now."""
        yield from self._asks.take(now)

    def _changed(self, now: float, form: Form, message: Any) -> Iterator[tuple[float, Any]]:
        data, word, late = _data(message), form.word, now + form.delay_s
        if word == "half_open" or (word == "lost" and self._count % LOST_OF == 0):
            return
        if word == "slow" or (word == "late_once" and self._count == 1):
            yield late, message
        elif word == "jitter":
            yield now + form.delay_s * self._chance.random(), message
        elif word == "doubled":
            yield from ((now, message), (now, message))
        elif word == "baud_9600":
            yield max(now, self._answers.last_at) + _size(message) / BYTES_PER_S, message
        elif word in OF_BYTES and data:
            yield from self._of_bytes(now, late, word, message, data)
        else:
            yield now, message

    def _of_bytes(
        self, now: float, late: float, word: str, message: Any, data: bytes
    ) -> Iterator[tuple[float, Any]]:
        half = len(data) // 2
        if word == "cut":
            yield now, replace(message, data=data[:half])
            yield late, replace(message, data=data[half:])
        elif word == "joined":
            yield from self._joined(now, late, message, data)
        elif word == "garbage":
            yield now, replace(message, data=GARBAGE)
            yield now, message
        elif word in ("reset", "left_over") and self._count == 1:
            self._left = [replace(message, data=data[half:])] if word == "left_over" else []
            yield now, replace(message, data=data[:half])
            yield now, CUT
        else:
            yield now, message

    def _joined(self, now: float, late: float, message: Any, data: bytes) -> Iterator[tuple[float, Any]]:
        """The answer behind the one that waits for it; one that is the first waits."""
        before, self._held = self._held, None
        if before is None:
            self._held = (late, message)
        elif _kind(before[1]) == _kind(message):
            yield now, replace(message, data=before[1].data + data)
        else:
            yield from ((now, before[1]), (now, message))

    def _release(self, now: float) -> None:
        if self._held is not None:
            self._answers.put(now, self._held[1])
            self._held = None


def _data(message: Any) -> bytes | None:
    found = getattr(message, "data", None)
    return found if isinstance(found, bytes) else None


def _size(message: Any) -> int:
    """The bytes of a message."""
    if isinstance(message, bytes):
        return len(message)
    data = _data(message)
    return len(str(getattr(message, "text", ""))) if data is None else len(data)


def _kind(message: Any) -> tuple[object, ...]:
    """The type and the port of a message: messages that share both have bytes of one stream."""
    return (type(message), getattr(message, "port", None))
