"""Lines to Marlin: one after another, each with its answer, and stops that pass them."""

from __future__ import annotations

from collections import deque
from enum import Enum
from typing import Any

from arboleda_drivers.connections.link import LinkBroken
from arboleda_drivers.connections.receipts import Receipts

from .controller import Halting
from .lines import written
from .marlin_lines import Capability, numbered

UNENDED_S = 10.0  # a stop that has not ended by then: an answer was lost, and each one counts for a line
STOP_AGAIN_S = 3.0  # Marlin drops all moves for a second, and for one more after a second stop
ASK_NAME = "M115"
PARSER = "EMERGENCY_PARSER"
NO_PARSER = (
    f"its M115 does not say {PARSER}:1, so a stop would wait behind what it is to stop; build the firmware "
    "with it"
)


class LineQueue:
    """Lines that wait for the answer to those before, and lines without an answer."""

    def __init__(self, out: list[Any]) -> None:
        self.waiting: deque[str] = deque()
        self.unanswered: deque[str] = deque()
        self._out = out
        self._number = 0

    @property
    def is_idle(self) -> bool:
        return not self.waiting and not self.unanswered

    @property
    def first(self) -> str:
        """The line that is answered next; "" for none."""
        return self.unanswered[0] if self.unanswered else ""

    def ask(self, line: str) -> None:
        self.unanswered.append(line)
        self._out.append(written(numbered(self._number, line)))
        self._number += 1

    def ask_at_once(self, line: str) -> None:
        """Ask without a number. Stops pass lines that were lost or are not read yet; other lines wait."""
        self.unanswered.append(line)
        self._out.append(written(line))

    def go_on(self) -> None:
        if self.waiting and not self.unanswered:
            self.ask(self.waiting.popleft())


class Halt(Enum):
    """Stop of Marlin, by its line."""

    QUICK = "M410"
    KILL = "M112"


class MarlinStop(Halting[Halt]):
    """Stop by a line that passes all others."""

    def __init__(self, queue: LineQueue, receipts: Receipts, now: float) -> None:
        super().__init__(receipts, now)
        self._queue, self._first_said_at = queue, now

    def begin(self, now: float, how: Halt) -> None:
        self._first_said_at = now if self.how is None else self._first_said_at
        super().begin(now, how)

    def say(self, now: float, halt: Halt) -> None:
        self.begin(now, halt)
        self._queue.ask_at_once(halt.value)

    def say_again(self, now: float) -> None:
        if self.how is not None:
            self.say(now, self.how)

    def insist(self, now: float) -> None:
        """Say a stop again that has not ended for long: what it asks for is the same however often.

        Raises LinkBroken once that is in vain.
        """
        if self.how is not None and now - self._first_said_at > UNENDED_S:
            raise LinkBroken(f"it has confirmed no stop for {UNENDED_S:g} s; an answer of it was lost")
        if now - self.since > STOP_AGAIN_S:
            self.say_again(now)


class Firmware:
    """Firmware of a controller by its own word: whether it is Marlin, with a parser that passes lines."""

    def __init__(self, queue: LineQueue) -> None:
        self.has_name = self.has_parser = False
        self._queue = queue

    def take_name(self, name: str) -> None:
        """Take the name: all answers before this one are those to lines of an earlier connection."""
        if self.has_name or ASK_NAME not in self._queue.unanswered:
            raise LinkBroken("it has told its name without being asked")
        if not name.startswith("Marlin"):
            raise LinkBroken(f"it is no Marlin, it says {name[:40]}")
        self.has_name = True
        while self._queue.first != ASK_NAME:
            self._queue.unanswered.popleft()

    def take_capability(self, capability: Capability) -> None:
        self.has_parser = self.has_parser or (capability.name == PARSER and capability.on)

    def check(self) -> None:
        """Raises LinkBroken for a firmware without the parser."""
        if not self.has_parser:
            raise LinkBroken(NO_PARSER)
