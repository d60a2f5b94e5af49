"""Release of parts on an operator's word: effectors let go, or a person has taken a part out."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.model.advice import sentence
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Failure, OperatorRequest, Reason
from arboleda.model.sentence import Phrase, Sentence
from arboleda.resume.walk_back import NO_PART

from ..cell import CellRun
from ..plant_state import PlantState
from ..readiness import STILL_DOING
from .cell_by_cell import CellByCell, Doing
from .homing import WITH_OTHER
from .scopes import Scopes, VerbRefusal

RELEASING = Phrase("doing.release", "letting go on the operator's word")
NOT_OPENED = Phrase("refusal.not_opened", "{why}: it cannot let go")
HOLD_FIRST = Phrase("refusal.hold_first", "{cell} is {state}; hold or stop it first")
NO_EFFECTOR = Phrase("refusal.no_effector", "{robot} has no effector")
HOLDS_NOTHING = Phrase("refusal.holds_nothing", "no part is known to be in {devices}")
HOLDS_NOTHING_ANY_MORE = Phrase(
    "refusal.holds_nothing_any_more",
    "no part is known to be in {devices}, so nothing has to be said of it; go on with {next}",
)
LET_GO = Phrase("part.let_go", "{arm} let go of its part on the operator's word")
AT_WORK = (CellState.EXECUTE, CellState.HOLDING, CellState.ABORTING)


class Releasing:
    """Release of parts from the devices that hold them."""

    def __init__(self, state: PlantState, scopes: Scopes, doing: Doing) -> None:
        self._state = state
        self._scopes = scopes
        self._doing = doing
        self._in_cells = CellByCell(doing, check=self._not_releasable, do=self._release)

    def plan(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan to have devices let go, cell by cell; by hand, a person has taken the parts out of all."""
        robots = self._scopes.robots(scope)
        cells = self._scopes.cells_in(request.verb, scope, robots)
        if request.by_hand:
            return self._planned_emptying(robots, cells)
        return self._in_cells.planned(robots, cells)

    def _planned_emptying(self, robots: frozenset[str], cells: list[CellRun]) -> Callable[[], None]:
        """Plan to note that a person took the parts out of devices, none of which the plant is moving."""
        for cell in cells:
            if cell.state in AT_WORK:
                raise VerbRefusal(HOLD_FIRST(cell=cell.cell.name, state=cell.state.sentence))
        able = [(cell, name) for cell in cells for name in self._holders(cell, robots)]
        if not able:
            raise VerbRefusal(self._none_able(robots, sorted(robots)[0]))
        holding = [(cell, name) for cell, name in able if name in cell.context.parts.holding]
        if not holding:
            raise VerbRefusal(_nothing_held(able))
        for cell, name in holding:
            if (entry := cell.context.commands.first_of(name)) is not None:
                raise VerbRefusal(STILL_DOING(robot=name, doing=entry.doing))
        return partial(self._empty, holding)

    def _empty(self, holding: list[tuple[CellRun, str]]) -> None:
        for cell, name in holding:
            _lose_part(cell, name)
            self._state.dispatcher.effectors.declare_empty(self._state.dispatcher.beliefs[name])
            self._state.dispatcher.wake([name])

    def _not_releasable(self, cell: CellRun, robots: frozenset[str]) -> Sentence | None:
        if cell.state in AT_WORK:
            return HOLD_FIRST(cell=cell.cell.name, state=cell.state.sentence)
        if cell.manual.teaching is not None:
            return cell.manual.teaching.sentence
        able = self._holders(cell, robots)
        if not able:
            first = next(each.name for each in cell.cell.robots if each.name in robots)
            return self._none_able(robots, first)
        obstacles = (self._state.dispatcher.obstacles.to_opening(name) for name in able)
        obstacle = next((each for each in obstacles if each), None)
        return NOT_OPENED(why=obstacle.sentence) if obstacle else None

    def _release(self, cell: CellRun, robots: frozenset[str]) -> None:
        for name in self._holders(cell, robots):
            if name in cell.cell.shared:
                cell.context.devices.claim(name)
            _lose_part(cell, name)
            make = self._state.dispatcher.model.robots[name].let_go
            now, name_of_cell = self._state.clock.now, cell.cell.name
            self._doing.sent.append(
                self._state.dispatcher.send(make, name_of_cell, RELEASING(), now, by_hand=True)
            )

    def _holders(self, cell: CellRun, robots: frozenset[str]) -> list[str]:
        """The robots that may hold parts and that this cell answers for."""
        holders = [name for name in cell.cell.holders if name in robots]
        return [*filter(cell.context.devices.answers_for, holders)] if cell.cell.shared else holders

    def _none_able(self, robots: frozenset[str], first: str) -> Sentence:
        """The reason why nothing can be released: no effector, or the device is with another cell."""
        for device in sorted(robots.intersection(self._state.dispatcher.model.shared)):
            holder = self._state.zones.holder(device)
            if holder is not None and self._state.dispatcher.model.robots[device].held_fact is not None:
                return WITH_OTHER(device=device, cell=holder)
        return NO_EFFECTOR(robot=first)


def _lose_part(run: CellRun, robot: str) -> None:
    """Note that the operator has an effector opened that held a part of the cell's task."""
    if robot in run.context.parts.holding:
        lost = Failure(reason=Reason.PART_LOST, sentence=LET_GO(arm=robot))
        run.lose(NO_PART(arm=robot), run.trouble or lost)


def _nothing_held(able: list[tuple[CellRun, str]]) -> Sentence:
    """The sentence that devices hold no part, and what leads on where their cell waits for something else."""
    devices = tuple(dict.fromkeys(name for _, name in able))
    next_steps = [each for cell, _ in able[:1] for each in cell.ways_out(cell.cell.name)]
    if next_steps:
        return HOLDS_NOTHING_ANY_MORE(devices=devices, next=sentence(next_steps))
    return HOLDS_NOTHING(devices=devices)
