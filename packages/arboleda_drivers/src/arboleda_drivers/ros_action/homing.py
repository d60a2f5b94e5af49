"""Homing of a device behind an action server, which moves nothing."""

from __future__ import annotations

from typing import Any

from arboleda.drivers import plain
from arboleda_drivers.connections.receipts import Receipts

from .events import MakeCall
from .health import Call, CallAnswer, HealthWatch

LONGEST_WORD = 120


class Homing:
    """Homing under the `id` of its command, "" for none: the device has to be heard, and out of a stop."""

    def __init__(self, health: HealthWatch, out: list[Any], receipts: Receipts) -> None:
        self.id = ""
        self._health, self._out, self._receipts = health, out, receipts

    def begin(self, now: float, id: str) -> None:
        if not self._health.is_well and not self._health.can_clear:
            self._receipts.reject(id, self._health.word)
            return
        self.id = id
        self._receipts.tell(accepted=id)
        if not self._health.is_well:
            self._out.append(MakeCall(call=self._health.clear(now)))

    def pass_time(self, now: float) -> None:
        if self.id and not self._health.is_well and (why := self._health.overdue(now)):
            self._fail(why)

    def see(self) -> None:
        """The device was measured."""
        if self.id and self._health.is_well:
            self._receipts.tell(done=self.id)
            self.id = ""

    def hear(self, now: float, answer: CallAnswer) -> None:
        """Take the answer to a call that clears a stop."""
        if not self.id:
            return
        following = self._health.answered(now, answer)
        if isinstance(following, Call):
            self._out.append(MakeCall(call=following))
        elif following is not None:
            self._fail(following)

    def _fail(self, why: str) -> None:
        self._receipts.tell(failed=self.id, failure=plain(why, LONGEST_WORD))
        self.id = ""
