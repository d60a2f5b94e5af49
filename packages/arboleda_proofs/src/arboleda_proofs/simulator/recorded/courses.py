"""Courses of tasks, as the statuses of their trees show them pass by pass.

`courses_are_as_seen` finds by it the time for which a task is held counted as its work.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import RECOVERY, Act, Await, Dwell, Plant
from arboleda.engine.inspection import time_of
from arboleda.model.messages import Course

from .starts import turns_of

TAKES_TIME = (Act, Await, Dwell)
OVER = (Status.SUCCESS, Status.FAILURE)
ROUNDING_S = 2e-3  # times are kept in ms


class TaskInProgress:
    """A task at work, with times in s of its cell's own time, which stands still while the cell is held.

    `whole`: it was seen from its beginning; else only what begins after `began` is known of it.
    """

    def __init__(self, task: str, nodes: Sequence[Behaviour], began: float, *, whole: bool) -> None:
        self.task = task
        self.nodes = nodes
        self.began = self.ended_at = began
        self.whole = whole
        self.begun: dict[Behaviour, float] = {}
        self._steps = [node for node in nodes if isinstance(node, TAKES_TIME)]
        self._was = {} if whole else {step: step.status for step in self._steps if not _waits(step)}
        self._turns: dict[Behaviour, list[int]] = {
            step: turns for step in self._steps if (turns := turns_of(step))
        }
        self._at_once: set[Behaviour] = set()  # steps of them that ended in the pass in which they began last
        self.rested: object = None  # as what its tree came to rest last
        self._repeats = False  # whether a step began more than once
        self._rests: list[float] = []  # when it came to rest
        self._over: dict[Behaviour, float] = {}  # since when steps have rested as done or failed
        self._reset: dict[Behaviour, float] = {}  # since when steps that began have rested as never begun

    def look(self, rested: object, now: float) -> None:
        """Take in the steps that have begun; called if the tree came to rest otherwise than before."""
        self.rested = rested
        self._rests.append(now)
        for step in self._steps:
            was = self._was.get(step, Status.INVALID)
            is_noted = step in self._over or step.status not in OVER
            if step.status is was and is_noted and step not in self._turns:
                continue
            _note_since(self._over, step, now, step.status in OVER)
            _note_since(self._reset, step, now, step.status is Status.INVALID and step in self.begun)
            self._was[step] = step.status
            begins = was is not step.status and (was is Status.INVALID or step.status is Status.RUNNING)
            if begins and step in self._turns and step.status is not Status.RUNNING:
                self._turns[step] = turns_of(step)
                self._at_once.add(step)
            elif begins:
                self._at_once.discard(step)
            if (step in self._turns and self._is_in_another_turn(step)) or begins:
                self._repeats = self._repeats or step in self.begun
                self.begun[step] = now

    def _is_in_another_turn(self, step: Behaviour) -> bool:
        """True if a step that runs now and ran before is in another turn of what repeats it."""
        if step.status is not Status.RUNNING:
            return False
        before, self._turns[step] = self._turns[step], turns_of(step)
        return step in self.begun and self._turns[step] != before

    @property
    def steps(self) -> Mapping[str, float]:
        """The beginnings of steps, earliest first, by name and count of that name in the tree.

        Of a step that began and ended within a pass only itself knows that; it counts where it may be so.
        """
        begun = {
            name: at for name, step in self._names.items() if (at := self._last_beginning(step)) is not None
        }
        return dict(sorted(begun.items(), key=lambda each: each[1]))

    def _last_beginning(self, step: Behaviour) -> float | None:
        """The time at which a step began last; None if it did not."""
        known = self.begun.get(step)
        if not isinstance(step, TAKES_TIME) or step.began in (-math.inf, known):
            return known
        after_s = step.began - self.began
        may_be = self._may_be_left(after_s) if known is None else self._began(step, after_s)
        return step.began if may_be else known

    @property
    def recovers(self) -> bool:
        """True while its recovery runs, as its work has failed."""
        return any(node.name == RECOVERY and node.status is Status.RUNNING for node in self.nodes)

    def differs(self, course: Course | None) -> bool:
        """True if the course that is told of the done task is not the one that was seen."""
        if course is None or not self.whole:
            return (course is None) is self.whole
        named, took = self._named(), self.ended_at - self.began
        unseen = [after_s for name, after_s in course.begun.items() if name not in named]
        known = course.begun.keys() <= self._names.keys()
        if abs(course.seconds - took) > ROUNDING_S or not known or not all(map(self._may_be_left, unseen)):
            return True
        return not all(self._began(step, course.begun.get(name, took)) for name, step in named.items())

    def _named(self) -> dict[str, Behaviour]:
        """The steps that began, by their names as courses have them."""
        return {name: node for name, node in self._names.items() if node in self.begun}

    @property
    def _names(self) -> Mapping[str, Behaviour]:
        """The nodes by their names of now: a step has values of a script in its name once it knows them."""
        number = Counter[str]()
        names = {}
        for node in self.nodes:
            number[node.name] += 1
            names[f"{node.name} #{number[node.name]}"] = node
        return names

    def _may_be_left(self, after_s: float) -> bool:
        """True if a step may have begun so many s after the task and been left in the same pass, as one whose
        time is over at once: it shows no beginning.
        """
        at = self.began + after_s
        return any(abs(each - at) <= ROUNDING_S for each in (*self._rests, self.ended_at))

    def _began(self, step: Behaviour, after_s: float) -> bool:
        """True if a step may have begun last so many s after the task. A repeated step that ends within a
        pass shows no beginning; it may have begun anew whenever the tree of its task came to rest.
        """
        at = self.began + after_s
        if abs(min(self.begun[step], self.ended_at) - at) <= ROUNDING_S:
            return True
        # A try that failed at once was seen with the number of the one after it.
        again = self._is_in_a_later_turn(step) or step in self._at_once
        if not self._repeats and not again:
            return False
        since = min(self._over.get(step, math.inf), self._reset.get(step, math.inf))
        if self._is_in_a_later_turn(step):  # one that a reset made neither done nor failed began since then
            since = self._over.get(step, self.begun[step]) - ROUNDING_S
        return at > since and any(abs(each - at) <= ROUNDING_S for each in (*self._rests, self.ended_at))

    def _is_in_a_later_turn(self, step: Behaviour) -> bool:
        """True if what repeats a step has gone on since it was seen to begin, maybe in that very instant."""
        return step in self._turns and turns_of(step) != self._turns[step]


class Courses:
    """Tasks at work in each cell; `ended` are those that ended in this pass, by id."""

    def __init__(self, plant: Plant) -> None:
        self.ended: dict[str, TaskInProgress] = {}
        self._at_work: dict[str, TaskInProgress] = {}
        self.begin(run.task.id for run in plant.cells.values() if run.task is not None)
        self.look(plant)

    @property
    def at_work(self) -> Mapping[str, TaskInProgress]:
        """The tasks at work, by cell."""
        return self._at_work

    def begin(self, at_work: Iterable[str]) -> None:
        """Begin with a plant that starts, and these tasks, which were at work before."""
        self._at_work.clear()
        self._began_before = frozenset(at_work)

    def look(self, plant: Plant) -> None:
        """Take in what the plant did in this step."""
        if self.ended:
            self.ended = {}
        for name, run in plant.cells.items():
            progress = self._at_work.get(name)
            if progress is not None and progress.nodes is not run.run.nodes:
                self.ended[progress.task], progress.ended_at = self._at_work.pop(name), time_of(run).now
                progress = None
            if progress is None and run.task is not None and run.run.nodes:
                whole = run.task.id not in self._began_before
                progress = TaskInProgress(run.task.id, run.run.nodes, time_of(run).now, whole=whole)
                self._at_work[name] = progress
            if progress is not None and progress.rested is not run.run.rested:
                progress.look(run.run.rested, time_of(run).now)


def _note_since(since: dict[Behaviour, float], step: Behaviour, now: float, is_so: bool) -> None:
    """Note since when something is so of a step, or that it is not."""
    if is_so:
        since.setdefault(step, now)
    else:
        since.pop(step, None)


def _waits(step: Behaviour) -> bool:
    """True for a step that began to wait anew when the plant started."""
    return isinstance(step, Await | Dwell) and step.status is Status.RUNNING
