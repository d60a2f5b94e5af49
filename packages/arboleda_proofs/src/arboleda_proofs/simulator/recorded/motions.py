"""Property of beats: a board gets the plant's while its motion has not ended, and none once it surely has.

`who_moves_hears_the_beat` finds by it beats to boards that need not move.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from arboleda.drivers import Evidence, MotionState, Robot

from .board_step import BoardStep
from .boards import fields as fields_of

BEATS = "beats"
MOTIONS = ("/juntas", "/camino", "/referencia")
MOVING = MotionState.MOVING.value
LINGER_S = 1.0 + 1e-9  # how long a board that names no command must report standing still


class Motions:
    """The last motion that left for one board, by its `_number`.

    `lasts`: it surely has not ended, `may_last`: it may not have. `_moved`: the board has reported moving
    since, or a stop followed; `_still_since`: it has reported standing still since then. `_least` is the
    oldest epoch that the board says it obeys.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._by_ids = robot.evidence is Evidence.IDS
        self._number: tuple[Any, Any] = (None, None)
        self.lasts = self.may_last = self._moved = False
        self._still_since: float | None = None
        self._boot: int | None = None
        self._least = -1

    def breaches(self, step: BoardStep) -> Iterator[str]:
        lasted, may_have_lasted, least = self.lasts, self.may_last, self._least
        for report, fields in step.told:
            self._follow(report.at, report.boot_id, fields)
        if step.is_lost or step.is_shut:
            self.lasts = self.may_last = False
        beats = []
        for each in step.published:
            if each.topic.endswith("/latido"):
                beats.append(fields_of(each.payload).get("epoca", -1))
            elif each.topic.endswith(MOTIONS):
                self._begin(fields_of(each.payload), is_sure=not step.is_lost)
                may_have_lasted = True
            elif each.topic.endswith("/paro"):
                self.lasts, self._moved = False, True
        # one of an epoch that the board has not confirmed yet fences those of before off
        fences = self._by_ids and any(epoch > min(least, self._least) for epoch in beats)
        if beats and not (may_have_lasted or self.may_last or fences):
            yield f"{self._robot.name} is told that somebody is there, and need not move"
        if step.is_beaten and lasted and self.lasts and not beats and not step.late:
            yield f"{self._robot.name} moves, and is not told that somebody is there"

    def _begin(self, body: Mapping[str, Any], *, is_sure: bool) -> None:
        self._number, self._still_since = (body.get("epoca"), body.get("seq")), None
        self.lasts, self.may_last, self._moved = is_sure and self._by_ids, True, False

    def _follow(self, at: float, boot: int | None, fields: Mapping[str, Any]) -> None:
        epoch, seq = self._number
        has_booted = self._boot is not None and boot != self._boot  # the first report tells of none
        if has_booted or seq in (fields.get("hecho"), fields.get("rechazo_seq")):
            self.lasts = False
        if has_booted or (self._by_ids and (fields.get("epoca_ack"), fields.get("hecho")) == (epoch, seq)):
            self.may_last = False
        self._boot, self._least = boot, max(fields.get("epoca_ack", -1), fields.get("epoca_min", -1))
        if fields["estado"] == MOVING:
            self._moved, self._still_since = True, None
        elif self._moved and self._still_since is None:
            self._still_since = at
        if not self._by_ids and self._still_since is not None and at >= self._still_since + LINGER_S:
            self.may_last = False
