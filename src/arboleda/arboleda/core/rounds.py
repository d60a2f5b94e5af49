"""Rounds over the cells in a step: each cell does what it can, until no cell has given another more to do.

Cells take their turns in the order of the plant file, never in that of a set: the same events have to give
the same in each run. What wakes a cell is collected before a round, so a cell that another one wakes has its
turn in the next round.
"""

from __future__ import annotations

import math

from arboleda.model.commands import Command, Stop
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import Fact, Notice, Remember, TaskChanged, TaskState
from arboleda.model.task import Task

from .cell import CellRun
from .cell_guard import CellGuard
from .cell_steps import WAITS
from .earlier_start import trail_of
from .plant_state import PlantState
from .zone_watch import ZoneWatch

ROUND_BOUND = 100  # rounds in one step; more means cells that wake each other for ever


class Rounds:
    def __init__(self, state: PlantState, guard: CellGuard, watch: ZoneWatch) -> None:
        self._state = state
        self._guard = guard
        self._watch = watch
        self._order = {name: number for number, name in enumerate(state.cells)}
        self._wakes: dict[str, float] = {}  # by cell
        self._next_wake = math.inf
        self._unplanned: set[str] = set()  # cells whose wakes may have changed
        self._shares = bool(state.dispatcher.model.shared)

    @property
    def next_wake(self) -> float:
        """The time at which a tree is to be woken next, s; worked out once it is asked for."""
        if self._unplanned:
            for name in self._unplanned:
                at = self._state.cells[name].due
                self._wakes[name] = math.inf if at is None else at
            self._unplanned.clear()
            self._next_wake = min(self._wakes.values())
        return self._next_wake

    def go(self, now: float) -> None:
        """Let each cell to which something happened do what it can, round after round until none does."""
        ledger, news = self._state.dispatcher.ledger, self._state.news
        soon = math.nextafter(now, math.inf)  # a wake after a hold may be earlier by one rounding
        if self._next_wake <= soon:
            woken = [name for name, at in self._wakes.items() if at <= soon]
            news.touched.update(woken)
            news.revised.update(woken)
        if not news.touched and not ledger.changed:
            return
        touched, news.touched = news.touched, set()
        for _ in range(ROUND_BOUND):
            changed, ledger.changed = ledger.changed, set()
            touched |= changed
            in_order = sorted(touched, key=self._order.__getitem__)
            did = set[str]()
            for name in in_order:
                if self._advanced(name, woken=name in changed):
                    did.add(name)
            news.revised |= changed | did
            self._unplanned |= touched
            if did:
                news.changes += 1
                if self._shares:
                    self._watch.give_back_shared()
            elif not ledger.changed:
                return
            touched = did
        for name in sorted(touched, key=self._order.__getitem__):
            restless = f"the cells do not come to rest in {ROUND_BOUND} rounds of one step"
            self._guard.break_down(name, ArboledaError(restless))

    def keep_trail(self, run: CellRun, before: int) -> None:
        """Put the trail of a cell's task into the outbox, before each command there from index `before` on.

        A restart has to know the step of each command that has left, so the trail precedes commands, and the
        word that the task runs. The trail says which steps are done, so the facts that those steps changed
        precede the trail. A stop waits for no trail: stops leave before anything of their step is kept.
        """
        text = trail_of(run)
        if text is None or run.task is None:
            return
        outbox = self._state.dispatcher.outbox
        first = before
        while first < len(outbox) and not _waits(outbox[first], run.task):
            first += 1
        facts, others = list[Command | Notice](), list[Command | Notice]()
        for each in outbox[first:]:
            (facts if _is_fact(each) else others).append(each)
        outbox[first:] = facts
        self._state.dispatcher.memory.remember(Fact.STEP, run.task.id, text)
        outbox += others

    def _advanced(self, name: str, *, woken: bool) -> bool:
        before = len(self._state.dispatcher.outbox)
        try:
            did = self._state.cells[name].advance(WAITS, woken=woken)
            if did or woken:
                self.keep_trail(self._state.cells[name], before)
        except Exception as error:  # noqa: BLE001 - whatever it is, it ends the work of this cell, not the plant
            self._guard.break_down(name, error)
            return False
        return did


def _waits(message: Command | Notice, task: Task) -> bool:
    """True for a message that waits for the trail: a command but a stop, and the word that the task runs."""
    if isinstance(message, TaskChanged):
        return message.task == task.id and message.state is TaskState.RUNNING
    return isinstance(message, Command) and not isinstance(message, Stop)


def _is_fact(message: Command | Notice) -> bool:
    """True for a fact, but not for the removal of a trail: that follows the end of its task."""
    return isinstance(message, Remember) and not (message.fact is Fact.STEP and message.value is None)
