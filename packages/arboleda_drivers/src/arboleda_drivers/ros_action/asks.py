"""Requests that a device end something: cancels of its actions, and the calls of a stop and of its end."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from typing import Any

from arboleda_drivers.connections.receipts import Receipts

from .events import GoalAnswer
from .goal import Goal
from .presence import End

ANSWER_S = 2.0  # a server answers a goal or a cancel in milliseconds

STOP, CLEAR = "halt", "clear"
Asked = End | str
"""The action whose goals are cancelled, or STOP or CLEAR, whose call was sent."""


class Asks:
    """Cancels and calls; each is repeated until it is answered. A stop is taken once all of them are.

    `messages` are what is sent for each, and the `unanswered` have no answer.
    """

    def __init__(
        self,
        messages: Mapping[Asked, Any],
        out: list[Any],
        receipts: Receipts,
        *,
        answer_s: float = ANSWER_S,
        unanswered: Collection[Asked] = (),
    ) -> None:
        self._messages, self._out, self._receipts = messages, out, receipts
        self._answer_s, self._unanswered = answer_s, unanswered
        self._asked_at: dict[Asked, float] = {}  # of those that are not answered
        self._answered_at: dict[Asked, float] = {}
        self._ids = {STOP: "", CLEAR: ""}

    @property
    def calls_stop(self) -> bool:
        return STOP in self._messages

    @property
    def is_stopping(self) -> bool:
        return any(key != CLEAR for key in self._asked_at)

    def is_open(self, key: Asked) -> bool:
        return key in self._asked_at

    def answered_for_s(self, now: float, key: Asked) -> float:
        """Time since the last cancel was answered, s; inf where none was, -inf while one is open."""
        return -math.inf if self.is_open(key) else now - self._answered_at.get(key, -math.inf)

    def begin(self, now: float, key: Asked) -> None:
        """Send a cancel or a call."""
        message = self._messages.get(key)
        if message is None:
            return
        if key not in self._unanswered:
            self._asked_at[key] = now
        self._receipts.news = True
        self._out.append(message)

    def stop(self, now: float, id: str) -> None:
        """End what runs, by all there is for that."""
        self._ids[STOP] = id
        for key in self._messages:
            if key != CLEAR:
                self.begin(now, key)
        self._settle()

    def clear(self, now: float, id: str) -> None:
        self._ids[CLEAR] = id
        self.begin(now, CLEAR)
        self._settle()

    def pass_time(self, now: float) -> None:
        for key, at in list(self._asked_at.items()):
            if now >= at + self._answer_s:
                self.begin(now, key)

    def answer(self, now: float, key: Asked, refusal: str = "") -> None:
        """Take an answer; what refuses a stop is asked again."""
        told = CLEAR if key == CLEAR else STOP
        if refusal:
            self._receipts.reject(self._ids[told], refusal)
            self._ids[told] = ""
        if not refusal or key == CLEAR:
            self._asked_at.pop(key, None)
            self._answered_at[key] = now
        self._settle()

    def hear_goal(self, now: float, end: End, goal: Goal | None, said: GoalAnswer) -> bool:
        """Take an answer of the server where that goal is open; True where it has refused it."""
        if goal is None or said.id != goal.key:
            if said.accepted:  # nobody waits for it any more
                self.begin(now, end)
            return False
        if not said.accepted:
            self._receipts.reject("" if goal.stopped else goal.id, "goal_refused")
            return True
        goal.accepted = True
        if goal.stopped:  # a cancel that came before it cannot have included it
            self.begin(now, end)
        else:
            self._receipts.tell(accepted=goal.id)
        return False

    def leave(self, ends: Iterable[End]) -> None:
        """Tell no end any more; what runs at these ends is cancelled as soon as they are there."""
        self._ids = {STOP: "", CLEAR: ""}
        for end in ends:
            if end in self._messages:
                self._asked_at[end] = -math.inf

    def forget(self, end: End) -> None:
        """It was started anew, and nothing runs there."""
        self._asked_at.pop(end, None)

    def _settle(self) -> None:
        """Say that stops were taken, where nothing of them is open."""
        for told, is_open in ((STOP, self.is_stopping), (CLEAR, CLEAR in self._asked_at)):
            if not is_open:
                self._receipts.tell(accepted=self._ids[told])
                self._ids[told] = ""
