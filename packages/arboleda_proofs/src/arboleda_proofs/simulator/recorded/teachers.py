"""People who teach, by what they asked for and what was answered: who holds a button, and since when not.

`a_lost_teacher_stops_the_robot` finds by it goals as far as the teacher wants to go, which nobody halts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from arboleda.model.messages import Jog, Journal, OperatorAnswer, Verb


class Teachers:
    """Cells that are taught, and by robot when its button was held last; `was`: those before a step."""

    def __init__(self) -> None:
        self.taught: dict[str, int] = {}  # cell -> the act that began it
        self.was: dict[str, int] = {}
        self.held_at: dict[str, float] = {}  # robot -> when
        self._over: dict[str, int] = {}  # cell -> the last press that somebody let go of

    def restart(self) -> None:
        """The plant has died: nobody teaches."""
        self.taught.clear()
        self.was.clear()
        self._over.clear()

    def look(self, requests: Sequence[Any], sent: Sequence[Any]) -> None:
        """Take in a step of the plant."""
        self.was = dict(self.taught)
        for event in requests:
            if isinstance(event, Jog):
                self._hear(event)
        for message in sent:
            if isinstance(message, OperatorAnswer) and message.refusal is None:
                self._begin_or_end(message)
            elif isinstance(message, Journal) and message.verb is Verb.AUTOMATIC:
                self.taught.pop(message.scope, None)

    def _hear(self, jog: Jog) -> None:
        if self.taught.get(jog.cell) != jog.session or jog.number <= self._over.get(jog.cell, 0):
            return
        if jog.held:
            self.held_at[jog.robot] = max(jog.at, self.held_at.get(jog.robot, -math.inf))
        else:
            self._over[jog.cell] = jog.number

    def _begin_or_end(self, answer: OperatorAnswer) -> None:
        scope = answer.scope.strip().lower()
        if answer.verb is Verb.TEACH and answer.act is not None:
            self.taught[scope] = answer.act
            self._over[scope] = 0
        elif answer.verb is Verb.AUTOMATIC:
            self.taught.pop(scope, None)
