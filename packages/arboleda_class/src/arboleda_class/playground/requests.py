"""Requests of people to a plant, and the sentences on their outcomes."""

from __future__ import annotations

from arboleda.dashboard import outcomes
from arboleda.dashboard.outcomes import Said
from arboleda.extension import Words
from arboleda.model.messages import OperatorAnswer, Outcome, TaskChanged
from arboleda.views import view

from .acts import TaskAsked, VerbAsked
from .film import FilmRun
from .run import Run


class Requests:
    """Requests without an end yet; `lines` are the sentences that were not said yet."""

    def __init__(self, words: Words) -> None:
        self.lines: list[Said] = []
        self.awaited: dict[str, VerbAsked | TaskAsked] = {}  # by token
        self._words = words
        self._followed: dict[int, dict[str, str]] = {}  # acts that devices carry out, by number

    def forget(self) -> None:
        self.awaited.clear()
        self._followed.clear()

    def hear(self, run: Run | FilmRun) -> None:
        """Say what became of them."""
        for token in [each for each in self.awaited if each in run.answers]:
            act, answer = self.awaited.pop(token), run.answers[token]
            if isinstance(answer, TaskChanged):
                self.lines.append(outcomes.of_task(self._words, view.change(answer)))
            elif isinstance(act, VerbAsked):
                self._take(act, answer)
        for number in [*self._followed]:
            self._follow(number, run)

    def _take(self, act: VerbAsked, answer: OperatorAnswer) -> None:
        named = outcomes.act(self._words, act.verb, act.scope, act.arguments, by_hand=act.by_hand)
        self.lines.append(outcomes.of_answer(self._words, answer, named))
        if answer.outcome is Outcome.UNDER_WAY and answer.act is not None:
            self._followed[answer.act] = named

    def _follow(self, number: int, run: Run | FilmRun) -> None:
        row = run.outcome(number)
        if row is None or row["outcome"] != Outcome.UNDER_WAY.value:
            named = self._followed.pop(number)
            if row is not None:
                outcome = Outcome(row["outcome"])
                self.lines.append(outcomes.of_outcome(self._words, outcome, row["why"], named))

    def taken_lines(self) -> list[Said]:
        lines, self.lines = self.lines, []
        return lines
