"""The people around a simulated plant: customers with tasks, an attendant who gets cells going again."""

from __future__ import annotations

from itertools import count

from arboleda.core.cell import CellRun
from arboleda.core.cell_states import CellState
from arboleda.core.messages import TaskChanged, TaskState, Verb
from arboleda.core.model import Cell, MotionState

from .chance import Dice
from .world import World

WAITING = 2  # tasks that the customers of a cell keep in its queue
ROUND_S = (2.0, 6.0)  # how long the attendant takes to come by again


class Customers:
    """Bring every cell its next task soon after one of theirs left its queue, until they `go`.

    They know their own tasks by the tokens of their requests. `cycles` counts the tasks, whoever asked for
    them, that started and ended.
    """

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        self._dice = Dice(seed, "customers")
        self._asked: dict[str, Cell] = {}  # by token
        self._waiting: set[str] = set()  # their own tasks that are in a queue
        self._started: set[str] = set()
        self._gone = False
        self._tokens = count(1)
        self.cycles = 0
        self.outcomes: dict[str, int] = {}
        world.watchers.append(self._look)
        for cell in world.model.cells:
            for _ in range(WAITING):
                self._come(cell)

    def go(self) -> None:
        """Bring no more."""
        self._gone = True

    def _look(self) -> None:
        for message in self._world.moment.sent:
            if isinstance(message, TaskChanged):
                if message.request is None:
                    self._follow(message)
                elif message.request in self._asked:
                    self._answered(message, self._asked.pop(message.request))

    def _answered(self, answer: TaskChanged, cell: Cell) -> None:
        if answer.state is TaskState.QUEUED:
            self._waiting.add(answer.task)
        else:
            self._come(cell)

    def _follow(self, change: TaskChanged) -> None:
        if change.task in self._waiting and change.cell is not None:
            self._waiting.discard(change.task)
            self._come(self._world.model.cell(change.cell))
        if change.state is TaskState.RUNNING:
            self._started.add(change.task)
        elif change.task in self._started:
            self._started.discard(change.task)
            self._count(change)

    def _count(self, change: TaskChanged) -> None:
        self.cycles += 1
        outcome = change.reason.value if change.reason else change.state.value
        self.outcomes[outcome] = self.outcomes.get(outcome, 0) + 1

    def _come(self, cell: Cell) -> None:
        self._world.at(self._world.now + self._dice.between(0.0, 1.0), self._ask, cell)

    def _ask(self, cell: Cell) -> None:
        if not self._gone:
            token = f"customer {next(self._tokens)}"
            self._asked[token] = cell
            self._world.request_task(self._text(cell), token)

    def _text(self, cell: Cell) -> str:
        if self._dice.chance(0.2):
            return f"{cell.name} palletizing"
        path, station = self._dice.pick(cell.paths), self._dice.below(len(cell.stations))
        return f"{cell.name} {path.code} {station}"


class Attendant:
    """Comes by every few seconds and does, cell by cell, the next thing that gets it going again."""

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        self._dice = Dice(seed, "attendant")
        self._next_round()

    def _next_round(self) -> None:
        self._world.at(self._world.now + self._dice.between(*ROUND_S), self._round)

    def _round(self, _: None) -> None:
        for cell in self._world.plant.cells.values():
            wanted = self._wanted(cell)
            if wanted is not None:
                verb, scope, by_hand = wanted
                if by_hand:
                    self._world.home_by_hand(scope)
                else:
                    self._world.request_verb(verb, scope)
        self._next_round()

    def _wanted(self, cell: CellRun) -> tuple[Verb, str, bool] | None:
        name = cell.cell.name
        if cell.state in (CellState.IDLE, CellState.HELD):
            if self._stopped_by_others(cell):
                return Verb.STOP, name, False
            if (lost := self._lost(cell)) is not None:
                return lost
        if cell.state is CellState.HELD:
            return self._held(cell)
        if cell.state in (CellState.ABORTED, CellState.CLEARING):
            return Verb.CLEAR, name, False
        if cell.state is CellState.STOPPED:
            return Verb.RESET, name, False
        return (Verb.RESUME, name, False) if cell.state is CellState.IDLE and cell.queue_paused else None

    def _held(self, cell: CellRun) -> tuple[Verb, str, bool]:
        name = cell.cell.name
        if cell.stranded:
            return Verb.ABANDON, name, False
        if cell.task is not None and cell.trouble is None:
            return Verb.RESUME, name, False
        if cell.task is None and cell.context.holding():
            return Verb.RELEASE, cell.cell.arm.name, False
        return (Verb.RETRY if self._dice.chance(0.5) else Verb.ABANDON), name, False

    def _stopped_by_others(self, cell: CellRun) -> bool:
        """Whether a robot says that it is stopped though no operator of this plant stopped it."""
        beliefs = [self._world.plant.dispatcher.beliefs[robot.name] for robot in cell.cell.robots]
        return any(belief.online and belief.state is MotionState.STOP_LATCHED for belief in beliefs)

    def _lost(self, cell: CellRun) -> tuple[Verb, str, bool] | None:
        """Homing, for a robot of the cell that is heard and does not know where it is."""
        beliefs = [self._world.plant.dispatcher.beliefs[robot.name] for robot in cell.cell.robots]
        for belief in beliefs:
            astray = belief.robot is cell.cell.arm and cell.context.astray() is not None
            if belief.online and (belief.unhomed or astray):
                return Verb.HOME, belief.robot.name, not belief.robot.says_homed
        return None
