"""Rule of beats: a board gets those of the plant while its motion has not ended, and none once it has."""

from __future__ import annotations

from collections import defaultdict
from typing import Any

from arboleda.drivers import MotionState, Robot
from arboleda.wire.transport import Publication

from .board_link import KnownLink
from .boards import fields as fields_of
from .telemetry import EXACT

BEATS = "beats"
MOVING = MotionState.MOVING.value
LINGER_S = 1.0  # how long a board that names no command must report standing still


class KnownMotion:
    """Last motion that was sent to a board.

    `number`: that of a motion which surely has not ended; `is_open`: one may be open; `had_ended`: none was
    after the step before. `moved`: the board has reported moving since, or a stop followed. `still_since`:
    it has reported standing still since then.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self.is_open = self.had_ended = self.moved = False
        self.still_since: float | None = None
        self._newest: tuple[int, int] | None = None  # (epoca, seq) of the last motion

    def begin(self, newest: tuple[int, int] | None) -> None:
        """Begin a motion; `newest` is its (epoca, seq) where the board has numbers."""
        self.is_open, self.moved, self.had_ended, self.still_since = True, False, False, None
        self._newest, self.number = newest, newest and newest[1]

    def halt(self) -> None:
        self.number, self.moved = None, True

    def lose(self) -> None:
        """Count no motion any more: the board is out of reach, or has booted."""
        self.number, self.is_open = None, False

    def follow(self, at: float, fields: dict[str, Any], *, by_ids: bool, booted: bool) -> None:
        """Take telemetry that counts, while a motion may be open."""
        if booted:
            self.lose()
        if by_ids and self._newest == (fields.get("epoca_ack"), fields.get("hecho")):
            self.is_open = False
        if fields["estado"] == MOVING:
            self.moved, self.still_since = True, None
        elif self.moved and self.still_since is None:
            self.still_since = at


class Beats:
    """Beats to one board; `has_arrived`: the plant's reached the bridge in this step."""

    def __init__(
        self, robot: Robot, motion: KnownMotion, *, by_ids: bool, wrong: defaultdict[str, list[str]]
    ) -> None:
        self.has_arrived = False
        self._name = robot.name
        self._motion = motion
        self._by_ids = by_ids
        self._wrong = wrong

    def compare(self, published: list[Publication], link: KnownLink, *, begins: bool, late: bool) -> None:
        """Compare what left in a step with what had to.

        `begins`: a motion was given in it, or a board came back whose counter began anew, and which may
        have forgotten the epoch of the bridge. `late`: the bridge was away before.
        """
        motion = self._motion
        arrived, self.has_arrived = self.has_arrived, False
        ended = not motion.is_open
        if motion.still_since is not None and not self._by_ids:
            ended |= link.telemetry_at >= motion.still_since + LINGER_S + EXACT
        before, motion.had_ended = motion.had_ended, ended
        if not (published or arrived):
            return
        beats = [each for each in published if each.topic.endswith("/latido")]
        if ended and before and not begins and beats and not self._fences(beats, link):
            self._wrong[BEATS].append(f"{self._name} is told that somebody is there, and need not move")
        if arrived and motion.number is not None and not beats and not late:
            self._wrong[BEATS].append(f"{self._name} moves, and is not told that somebody is there")

    def _fences(self, beats: list[Publication], link: KnownLink) -> bool:
        """True if a beat fences older epochs off, which the board has not confirmed yet."""
        least = min(link.least, link.least_before)
        return self._by_ids and any(fields_of(each.payload).get("epoca", -1) > least for each in beats)
