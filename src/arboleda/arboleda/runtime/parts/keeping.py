"""Keeping of the facts, acts and tasks of a plant that runs, as long as it leads."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from arboleda.adapters import clock
from arboleda.departures.leading import Standing, may_leave
from arboleda.departures.leaving import ends_motion
from arboleda.engine import Plant
from arboleda.model.commands import Command
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import ENDED, Journal, Notice, Remember, TaskChanged, Verb
from arboleda.store.lead import Superseded
from arboleda.store.plant_memory import PlantMemory

from .durability import Durability
from .part import Crash

DAY_S = 86_400.0
AT_ONCE_S = 1.0  # a start reads its clocks within it


class Keeping:
    """Keeping of what the plant does, in its `store` before anything after it leaves.

    Nothing is kept without a store. Once something could not be kept, `failure` says why; `crash` is told,
    and nothing is kept any more. `tell` gets what is durable, as `Durability` says.
    """

    def __init__(
        self,
        plant: Plant,
        store: PlantMemory | None,
        tell: Callable[[Any, Exception | None], None],
        crash: Crash,
        calendar: clock.Calendar,
    ) -> None:
        self.store = store
        self._calendar = calendar
        self._ran_before_s = 0.0 if store is None else store.tasks.ran_s()
        self._began_s = clock.seconds()
        self.failure: Exception | None = None
        self.durability = Durability(store, tell, self.fail)
        self._plant = plant
        self._crash = crash
        self._noted = False  # whether facts are written that are not committed

    def follow_clock(self) -> float:
        """The seconds by which the wall clock was set since the last look; the times of this start follow."""
        by_s = self._calendar.look()
        if by_s and self.store is not None and self.failure is None:
            try:
                now_s, before_s = self._calendar.unix_s(), self._ran_before_s
                self.store.move_times(by_s, now_s, before_s, self.ran_s() - before_s + AT_ONCE_S)
            except ArboledaError as error:
                self.fail(error)
        return by_s

    def ran_s(self) -> float:
        """The time that the plant has run over all of its starts, s; never more than has passed."""
        return self._ran_before_s + clock.seconds() - self._began_s

    @property
    def leads_for_certain(self) -> bool:
        """True if a stop may leave without asking the store, which may hang."""
        if self.store is None or self.failure is not None:
            return self.standing is not Standing.SUPERSEDED
        return self.store.lead.is_certain

    def lets_leave(self, message: Command | Notice) -> bool:
        """True if this plant may send a message: once another process has taken it over it sends nothing, not
        even a stop; if it cannot find out, it stops what moves, and ends. A command does not wait to find out
        while this process leads for certain: the files are looked at when its step is committed, right after
        it, and at each heartbeat."""
        goes_at_once = ends_motion(message) or (isinstance(message, Command) and self.failure is None)
        if goes_at_once and self.leads_for_certain:
            return True
        if self.store is not None and self.failure is None:
            try:
                self.store.confirm()
            except ArboledaError as error:
                self.fail(error)
        leaves = may_leave(message, self.standing)
        if not leaves and isinstance(message, Command) and self.failure is not None:
            raise self.failure
        return leaves

    @property
    def standing(self) -> Standing:
        if self.failure is None:
            return Standing.LEADS
        return Standing.SUPERSEDED if isinstance(self.failure, Superseded) else Standing.UNSURE

    def fail(self, error: Exception) -> None:
        """End the plant, as nothing can be kept any more."""
        self.failure = error
        self._crash("orchestrator", error)

    def keep_act(self, message: Journal) -> None:
        """Keep an operator's act, and how often it has had tasks begun."""
        if self.store is None or self.failure is not None:
            return
        self.store.acts.keep(message, self._calendar.unix_s())
        self._wrote(message)
        if message.verb is Verb.RETRY and message.outcome is None:
            for name in [message.cell] if message.cell else self._plant.cells:
                task = self._plant.cells[name].task
                if task is not None:
                    self.store.tasks.attempted(task.id, task.attempts)

    def keep_facts(self, facts: Sequence[Remember]) -> None:
        """Keep facts before what comes after them leaves; what need not be durable then is only noted."""
        if self.store is None or self.failure is not None:
            return
        if any(map(self._plant.precedes_commands, facts)):
            self.store.keep(*facts)
            self.durability.wrote(precedes_commands=True)
        else:
            if self._noted:
                self.settle()
            self.store.note(*facts)
            self._noted = True

    def settle(self) -> None:
        """Commit what was noted."""
        if self._noted and self.store is not None and self.failure is None:
            self._noted = False
            self.store.settle()
            self.durability.wrote(precedes_commands=False)

    def keep_task(self, change: TaskChanged, asked_by: str) -> None:
        """Keep a change of a task, which came by the way `asked_by`."""
        if self.store is None:
            return
        known, unix_s = self._plant.intake.tasks.get(change.task), self._calendar.unix_s()
        recipe, answers = (known.order.recipe, known.answers) if known else ("", [])
        ran_s = self.ran_s()
        self.store.tasks.keep(change, recipe, unix_s, asked_by, answers, ran_s)
        if change.state in ENDED:
            self.store.tasks.forget(ran_s - self._plant.model.history_days * DAY_S)
        self._wrote(change)

    def _wrote(self, *changes: Remember | Journal | TaskChanged) -> None:
        self.durability.wrote(precedes_commands=any(map(self._plant.precedes_commands, changes)))
