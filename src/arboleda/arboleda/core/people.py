"""People at the plant: their verbs, and the buttons that a teacher holds, are carried out or refused."""

from __future__ import annotations

from functools import partial

from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import InternalError, Jog, OperatorAnswer, OperatorRequest
from arboleda.model.outside import quoted
from arboleda.model.sentence import Sentence

from .cell_guard import CellGuard
from .operator import Operator
from .plant_state import PlantState
from .rounds import Rounds
from .task_desk import DEFECT
from .teaching import NOT_TAUGHT, OTHER_TEACHES, Teaching
from .verbs.scopes import NO_SCOPE, VerbRefusal


class People:
    """People who operate a plant, or teach its cells."""

    def __init__(self, state: PlantState, operator: Operator, guard: CellGuard, rounds: Rounds) -> None:
        self._state = state
        self._operator = operator
        self._guard = guard
        self._rounds = rounds

    def operate(self, request: OperatorRequest) -> None:
        """Carry out a verb, or refuse it, and answer."""
        self._state.news.changes += 1
        refusal, before, act = None, len(self._state.dispatcher.outbox), None
        try:
            act = self._operator.act(request)
            for run in self._state.cells.values():
                self._rounds.keep_trail(run, before)
        except (VerbRefusal, IllegalTransition) as error:
            refusal = error.sentence
        except Exception as error:  # noqa: BLE001 - whoever asks gets an answer, and the plant goes on
            refusal = DEFECT()
            self._state.dispatcher.outbox.append(InternalError(cell="", error=error))
        answer = OperatorAnswer(
            verb=request.verb,
            scope=request.scope,
            arguments=request.arguments,
            refusal=refusal,
            request=request.request,
            act=act.number if act else None,
            outcome=act.outcome if act else None,
            why=act.why if act else None,
        )
        self._state.dispatcher.outbox.append(answer)

    def jog(self, jog: Jog) -> None:
        """Take the button that a teacher holds; one of another teaching than the present is passed over."""
        run = self._state.cells.get(jog.cell)
        if run is None or run.manual.teaching is None or run.manual.teaching.session != jog.session:
            return
        self._guard.run(jog.cell, partial(self._take_jog, run.manual.teaching, jog))

    def jog_refusal(self, jog: Jog) -> Sentence | None:
        """The reason why this button would move nothing now; None where something would."""
        run = self._state.cells.get(jog.cell)
        if run is None:
            return NO_SCOPE(scope=quoted(jog.cell), known=(*self._state.cells,))
        if run.manual.teaching is None:
            return NOT_TAUGHT(cell=jog.cell)
        if run.manual.teaching.session != jog.session:
            return OTHER_TEACHES(cell=jog.cell, teacher=run.manual.teaching.teacher)
        return run.manual.teaching.refusal(jog)

    def _take_jog(self, teaching: Teaching, jog: Jog) -> None:
        self._state.news.touched.add(jog.cell)
        if teaching.take(jog):
            self._state.news.changes += 1
            self._state.news.revised.add(jog.cell)
