"""Verbs of operators and their answers, step by step.

`every_request_is_answered` finds by it an empty task text that is passed over.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from arboleda.model.messages import OperatorAnswer, OperatorRequest, Verb

from .scopes import Scopes

NO_VERBS: frozenset[Verb] = frozenset()


class OperatorRequests:
    """Verbs of one step, with the `answers` of the plant; `unanswered`: those that have none yet, in order.

    `cancels_a_task`: somebody cancels a task by its id. `undisturbed`: no operator has asked for anything
    yet, in any step.
    """

    def __init__(self, scopes: Scopes) -> None:
        self.answers: list[OperatorAnswer] = []
        self.cancels_a_task = False
        self.undisturbed = True
        self._scopes = scopes
        self._verbs: dict[str, set[Verb]] = {}  # robot -> what was asked for on it in this step
        self.unanswered: deque[OperatorRequest] = deque()

    def hear(self, events: Iterable[object]) -> None:
        """Take in what people ask for in this step."""
        self.hear_last(events)
        for request in self.unanswered:
            self.cancels_a_task |= request.verb is Verb.CANCEL and request.scope not in self._scopes
            for robot in self._scopes.robots(request.scope):
                self._verbs.setdefault(robot, set()).add(request.verb)

    def hear_last(self, words: Iterable[object]) -> tuple[OperatorRequest, ...]:
        """Take in what a plant was asked in the step in which it died, and return the verbs among it."""
        self.unanswered = deque(each for each in words if isinstance(each, OperatorRequest))
        self.undisturbed &= not self.unanswered
        return tuple(self.unanswered)

    def take(self, answer: OperatorAnswer) -> OperatorRequest:
        """Take in an answer, and return the request that it answers."""
        self.answers.append(answer)
        return self.unanswered.popleft()

    def verbs(self, robot: str) -> frozenset[Verb]:
        """The verbs of this step on a robot, refused or not."""
        return frozenset(self._verbs.get(robot, NO_VERBS))

    def done(self, robot: str, sent: Iterable[object]) -> frozenset[Verb]:
        """The verbs of this step on a robot, without those that are refused by what the plant has `sent`."""
        if robot not in self._verbs:
            return NO_VERBS
        answers = [each for each in sent if isinstance(each, OperatorAnswer)]
        done = {answer.verb for answer in answers if answer.refusal is None}
        refused = {answer.verb for answer in answers if answer.refusal is not None}
        return frozenset(self._verbs[robot] - (refused - done))

    def end_step(self) -> None:
        """Forget what was asked for: the plant has done it, or refused it."""
        self._verbs.clear()
        self.cancels_a_task = False
