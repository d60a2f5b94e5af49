"""Manual mode of cells on an operator's word: a person begins to teach a cell, or ends that."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.model.messages import Fact, Journal, OperatorRequest, Verb
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Sentence

from .. import reasons
from ..acts import Acts
from ..cell import CellRun
from ..plant_state import PlantState
from ..teaching import NOT_TAUGHT, OTHER_TEACHES, ZONE_OF_OTHER, Teaching
from .cell_by_cell import AT_REST
from .scopes import NO_SCOPE, Scopes, VerbRefusal
from .stops import NOT_STILL

NOT_AT_REST = Phrase(
    "refusal.not_at_rest",
    "{cell} is {state}; only a cell that is idle, or held without a task, can be taught",
)
NO_TEACHER = Phrase("refusal.no_teacher", "say who teaches {cell}, in 1 to {most} letters")
TEACHING_ENDED = Phrase("teach.ended", "teaching of {cell} by {teacher} ended: {why}")
BY_VERB = Phrase("teach.by_verb", "by the operator")()
LONGEST_NAME = 40


class TaughtCells:
    """Manual mode of cells; the teacher's name is a fact of the memory until the teaching ends."""

    def __init__(self, state: PlantState, scopes: Scopes, acts: Acts) -> None:
        self._state = state
        self._scopes = scopes
        self._acts = acts
        for cell in scopes.cells.values():
            cell.manual.when_over = partial(self._over, cell)

    def plan(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan to teach one cell that rests, while no robot of another cell is where its robots may get."""
        cells = self._scopes.cells_in(request.verb, scope, self._scopes.robots(scope))
        teacher = str(request.argument("teacher") or "").strip()
        cell = cells[0]
        if len(cells) > 1 or scope not in self._scopes.cells:
            raise VerbRefusal(NO_SCOPE(scope=quoted(scope), known=(*self._scopes.cells,)))
        if not 0 < len(teacher) <= LONGEST_NAME or not teacher.isprintable():
            raise VerbRefusal(NO_TEACHER(cell=scope, most=LONGEST_NAME))
        if (refusal := self._not_teachable(cell)) is not None:
            raise VerbRefusal(refusal)
        return partial(self._teach, cell, teacher)

    def _not_teachable(self, cell: CellRun) -> Sentence | None:
        name, rests = cell.cell.name, cell.state in AT_REST and cell.task is None
        if cell.manual.teaching is not None:
            return OTHER_TEACHES(cell=name, teacher=cell.manual.teaching.teacher)
        if cell.closed:
            return reasons.ENDING()
        if not rests:
            return NOT_AT_REST(cell=name, state=cell.state.sentence)
        if (busy := cell.readiness.busy()) is not None:
            return busy
        for robot in (each for each in cell.cell.reached if each.goes and each.name in cell.cell.own):
            obstacle = self._state.dispatcher.beliefs[robot.name].unreachable()
            if obstacle is not None:
                return obstacle.sentence
            if self._state.dispatcher.beliefs[robot.name].moves:
                return NOT_STILL(robots=(robot.name,))
        return _zone_of_other(cell)

    def _teach(self, cell: CellRun, teacher: str) -> None:
        cell.context.zones.forsake()
        self._state.dispatcher.memory.remember(Fact.MANUAL, cell.cell.name, teacher)
        cell.manual.begin(Teaching(cell.context, session=self._acts.next_number, teacher=teacher))

    def _over(self, cell: CellRun, teaching: Teaching, why: Sentence) -> None:
        """Forget who taught a cell; journal an end that no operator has asked for."""
        name = cell.cell.name
        self._state.dispatcher.memory.remember(Fact.MANUAL, name, None)
        if why is not BY_VERB:
            sentence = TEACHING_ENDED(cell=name, teacher=teaching.teacher, why=why)
            entry = Journal(verb=Verb.AUTOMATIC, scope=name, cell=name, sentence=sentence)
            self._state.dispatcher.outbox.append(entry)


def not_taught(cell: CellRun, robots: frozenset[str]) -> Sentence | None:
    """The reason why the manual mode of a cell cannot be ended."""
    return NOT_TAUGHT(cell=cell.cell.name) if cell.manual.teaching is None else None


def _zone_of_other(cell: CellRun) -> Sentence | None:
    """The refusal where a robot of another cell is, or may be, where robots of this cell may get."""
    for robot in filter(cell.context.devices.has, cell.cell.zone_users):
        for zone, holder in cell.context.zones.taken_by_others(robot).items():
            if holder not in cell.cell.own and not cell.context.zones.is_for_task(zone):
                return ZONE_OF_OTHER(robot=robot, zone=zone, holder=holder)
    return None
