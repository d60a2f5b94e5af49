"""Work of a machine with Klipper: moves in pieces, homing, stops, and the requests without an answer."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from arboleda_drivers.connections.receipts import Receipts

from .controller import Halting
from .lines import written
from .moonraker_lines import Motion, Place, near, request
from .settings import LETTERS

PIECE_S = 0.25
AHEAD_S = 1.25  # of travel that is sent: Klipper brakes where it has less than 0.7 s, and tells it 0.5 s late
STOP_S = 3.5  # for what was sent to end; then it is shut down
DOWN_S = 1.0  # a shutdown takes milliseconds, and somewhat longer to a second controller
ABSOLUTE = "G90"  # the line that is harmless wherever it waits
ASIDE_MM = 2.0  # of a straight way; a mesh of the bed leads aside by less


class Ask(Enum):
    """Request without an answer, by what it is for."""

    NAME = auto()
    STATUS = auto()
    TURN = auto()  # the turn of a move: another client's lines may have Klipper's queue
    PIECE = auto()
    HOME = auto()
    END = auto()  # of all moves before a stop
    SHUTDOWN = auto()


class Requests:
    """Requests over one connection by their numbers; what was asked up to `old` may tell of a time before."""

    def __init__(self, out: list[Any]) -> None:
        self.number = self.old = 0
        self._out = out
        self._open: dict[int, Ask] = {}

    def ask(self, ask: Ask, method: str, **params: object) -> None:
        self.number += 1
        self._open[self.number] = ask
        self._out.append(written(request(self.number, method, params)))

    def script(self, ask: Ask, *lines: str) -> None:
        self.ask(ask, "printer.gcode.script", script="\n".join(lines))

    def waits_for(self, *asks: Ask) -> bool:
        return any(each in asks for each in self._open.values())

    def take(self, number: int) -> Ask | None:
        """The request that an answer is to; None for none of these."""
        return self._open.pop(number, None)

    def drop(self) -> None:
        """Wait no more for what Klipper was told: it has ended."""
        self._open = {number: ask for number, ask in self._open.items() if ask in (Ask.NAME, Ask.STATUS)}


class Halt(Enum):
    """Stop that is under way."""

    NO_MORE = auto()  # pieces, and those that were sent are made
    SHUTDOWN = auto()


class MoonrakerStop(Halting[Halt]):
    """Stop: no more is sent, or Klipper is shut down."""

    def __init__(self, requests: Requests, receipts: Receipts, now: float) -> None:
        super().__init__(receipts, now)
        self._requests = requests

    def send_no_more(self, now: float) -> None:
        if self.how is not Halt.SHUTDOWN:
            self.begin(now, Halt.NO_MORE)
            self._requests.script(Ask.END, "M400")  # it is answered once all before it has ended

    def shut_down(self, now: float) -> None:
        self.begin(now, Halt.SHUTDOWN)
        self._requests.ask(Ask.SHUTDOWN, "printer.emergency_stop")

    def go_on(self, now: float, *, is_ready: bool) -> None:
        """Go on with a stop that is under way, if one is; `is_ready`: Klipper is."""
        if self.how is None:
            return
        if not is_ready:
            if now - self.since > DOWN_S:
                self.end()
        elif now - self.since > (STOP_S if self.how is Halt.NO_MORE else DOWN_S):
            self.shut_down(now)  # what it asks for is the same however often it is said


@dataclass(kw_only=True)
class Move:
    """Straight way, of which `sent` of `pieces` were sent: begun in its turn, taken by the first answer."""

    id: str
    sent_at: float
    start: Place
    goal: Place
    base: Place
    mm_s: float
    turn: int = 0  # the number of its request
    sent: int = 0
    has_turn: bool = False
    is_taken: bool = False

    @property
    def length(self) -> float:
        return math.dist(self.start, self.goal)

    @property
    def pieces(self) -> int:
        return max(1, math.ceil(self.length / (self.mm_s * PIECE_S)))

    def end_of(self, piece: int) -> Place:
        part = piece / self.pieces
        return tuple(a + (b - a) * part for a, b in zip(self.start, self.goal, strict=True))

    def sent_beyond(self, place: Place) -> float:
        """The way, mm, that was sent and lies before the machine."""
        return self.length * self.sent / self.pieces - math.dist(self.start, place)

    def send_pieces(self, requests: Requests, motion: Motion, axes: Iterable[str]) -> None:
        """Send as much as Klipper needs not to brake, by where it has told to be."""
        ahead_mm = AHEAD_S * min(self.mm_s, motion.fastest)
        while self.sent < self.pieces and motion.ahead_s < AHEAD_S:
            if self.sent > 0 and self.sent_beyond(motion.place) >= ahead_mm:
                break
            self.sent += 1
            end = self.end_of(self.sent)
            words = "".join(
                f"{letter}{end[index] - self.base[index]:.4f}"
                for index, letter in enumerate(LETTERS[:3])
                if letter in axes
            )
            requests.script(Ask.PIECE, ABSOLUTE, f"G1{words}F{self.mm_s * 60:.1f}")

    def leads_by(self, place: Place) -> bool:
        """True where a place is on the way, or near it."""
        way = [b - a for a, b in zip(self.start, self.goal, strict=True)]
        gone = [here - a for a, here in zip(self.start, place, strict=True)]
        product = sum(a * b for a, b in zip(way, gone, strict=True))
        part = min(1.0, max(0.0, product / self.length**2)) if self.length > 0 else 0.0
        return math.dist(gone, [part * each for each in way]) < ASIDE_MM

    def has_sent(self, place: Place) -> bool:
        """True where a place is an end of what was sent."""
        return any(near(place, self.end_of(piece)) for piece in range(self.sent + 1))


@dataclass(kw_only=True)
class Homing:
    """Homing cycle, and its answer."""

    id: str
    began_at: float
    is_answered: bool = False
