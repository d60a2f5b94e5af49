"""Courses of tasks: when each step of a tree began, as its trees show it pass by pass."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import RECOVERY, Act, Await, Dwell, Plant
from arboleda.model.messages import Course

RUNNING = Status.RUNNING
TAKES_TIME = (Act, Await, Dwell)
ROUNDING_S = 2e-3  # times are kept in ms
Step = Act | Await | Dwell
UNBEGUN = (Status.INVALID, -math.inf)


class TaskInProgress:
    """A task at work, with times in s of its cell's own time, which stands still while the cell is held.

    `whole`: it was seen from its beginning. `is_true`: each step that was seen to begin has said so, and no
    step has told another beginning than the time of the pass in which it was said.
    """

    def __init__(self, task: str, nodes: Sequence[Behaviour], began: float, *, whole: bool) -> None:
        self.task = task
        self.nodes = nodes
        self.began = self.ended_at = began
        self.whole = whole
        self.is_true = True
        self.rested: object = None  # as what its tree came to rest last
        self._steps: list[Step] = [node for node in nodes if isinstance(node, TAKES_TIME)]
        self._was: dict[Step, tuple[Status, float]] = {}  # status and beginning at the last rest

    def look(self, rested: object, now: float) -> None:
        """Take in the steps that have begun; called if the tree came to rest otherwise than before."""
        self.rested = rested
        for step in self._steps if self.whole else ():
            status, before = self._was.get(step, UNBEGUN)
            begins = step.status is not status and (status is Status.INVALID or step.status is RUNNING)
            if step.began != now and (begins or step.began != before):
                self.is_true = False
            self._was[step] = step.status, step.began

    @property
    def steps(self) -> Mapping[str, float]:
        """The beginnings of steps, earliest first, by name and count of that name in the tree."""
        number, begun = Counter[str](), dict[str, float]()
        for node in self.nodes:
            number[node.name] += 1
            if isinstance(node, TAKES_TIME) and node.began > -math.inf:
                begun[f"{node.name} #{number[node.name]}"] = node.began
        return dict(sorted(begun.items(), key=lambda each: each[1]))

    @property
    def recovers(self) -> bool:
        """True while its recovery runs, as its work has failed."""
        return any(node.name == RECOVERY and node.status is RUNNING for node in self.nodes)

    def differs(self, course: Course | None) -> bool:
        """True if the course that is told of the done task is not the one that was seen."""
        if course is None or not self.whole:
            return (course is None) is self.whole
        begun = {name: at - self.began for name, at in self.steps.items()}
        took = self.ended_at - self.began
        told = {name: course.begun.get(name, took) for name in begun}  # of those that begin last none is
        is_so = all(abs(told[name] - at) <= ROUNDING_S for name, at in begun.items())
        in_time = abs(course.seconds - took) <= ROUNDING_S
        return not (in_time and is_so and self._is_true_at_the_end() and course.begun.keys() <= begun.keys())

    def _is_true_at_the_end(self) -> bool:
        """True if what has begun since the last rest says that it began as the task ended."""
        return self.is_true and all(
            step.began in (self._was.get(step, UNBEGUN)[1], self.ended_at) for step in self._steps
        )


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
                self.ended[progress.task], progress.ended_at = self._at_work.pop(name), run.context.time.now
                progress = None
            if progress is None and run.task is not None and run.run.nodes:
                whole = run.task.id not in self._began_before
                progress = TaskInProgress(run.task.id, run.run.nodes, run.context.time.now, whole=whole)
                self._at_work[name] = progress
            if progress is not None and progress.rested is not run.run.rested:
                progress.look(run.run.rested, run.context.time.now)
