"""Work of a machine with Klipper: moves in pieces, homing, and the requests that have no answer yet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, auto

from .moonraker_lines import Place, near

PIECE_S = 0.25
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


class Halt(Enum):
    """Stop that is under way."""

    NO_MORE = auto()  # pieces, and those that were sent are made
    SHUTDOWN = auto()


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
