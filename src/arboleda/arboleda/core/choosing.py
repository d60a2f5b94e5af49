"""Choice among cells that may do a task: the cell that is expected to have done it first."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

from arboleda.model.messages import TaskState
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order, Task

from . import reasons
from .cell import CellRun

CHOSEN = Phrase("choice.chosen", "{cell} is expected to have done it first, in {seconds:.0f} s; {others}")
CHOSEN_IN_TROUBLE = Phrase(
    "choice.chosen_in_trouble",
    "none of the cells can begin it now; {cell} is expected to need the least time, {seconds:.0f} s: {why};"
    " {others}",
)
LATER = Phrase("choice.later", "{cell} in {seconds:.0f} s")
HINDERED = Phrase("choice.hindered", "not {cell}: {why}")
FULL = Phrase("choice.full", "not {cell}: its queue is full")
UNKNOWN_S = 60.0  # the time that a task is expected to need where no task was ever done
LAST = 5  # so many of the last alike tasks count
Key = tuple[str, ...]
ANY: Key = ("any",)


class PastTimes:
    """Times of tasks that were done, as far as the plant remembers them."""

    def __init__(self, tasks: Iterable[Task]) -> None:
        self._done: dict[Key, deque[Task]] = {}
        for task in tasks:
            if task.state is TaskState.DONE and _took(task) >= 0:  # less where a clock was set back
                for key in (*_keys(task.order), ANY):
                    self._done.setdefault(key, deque(maxlen=LAST)).append(task)

    def expected(self, order: Order) -> float:
        """The median time of the last tasks of its text; else of its recipe here, or anywhere, or of all."""
        alike = next((self._done[key] for key in (*_keys(order), ANY) if key in self._done), ())
        return median(map(_took, alike)) if alike else UNKNOWN_S

    def remaining_s(self, order: Order, steps: Sequence[tuple[str, float]]) -> float | None:
        """The time (s) that a running task still needs: the median of alike tasks at its last common step.

        `steps` are those of the task, the last first, and how many s ago each began. None where no alike task
        had any of these steps.
        """
        for key in _keys(order):
            courses = [task.course for task in self._done.get(key, ()) if task.course is not None]
            for step, seconds in steps:
                all_needed = [course.remaining_s(step, seconds) for course in courses]
                if needed := [each for each in all_needed if each is not None]:
                    return median(needed)
        return None


def _keys(order: Order) -> tuple[Key, ...]:
    """The keys of tasks that are alike, the most alike first."""
    if not order.recipe:
        return (("text", order.text),)
    return ("text", order.text), ("cell", order.cell, order.recipe), ("recipe", order.recipe)


def _took(task: Task) -> float:
    """The time (s) of a task that was done; without its holds, where it has a course."""
    if task.course is not None:
        return task.course.seconds
    return (task.ended_at or 0.0) - (task.started_at or 0.0)


@dataclass(frozen=True, kw_only=True)
class Prospect:
    """Promise of a cell: in how many s it would have done an order, and what hinders it from beginning."""

    order: Order
    seconds: float
    hindrance: Sentence | None
    is_full: bool

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """The lowest rank is the best."""
        return self.is_full, self.hindrance is not None, self.seconds


def prospect(order: Order, run: CellRun, times: PastTimes, now: float) -> Prospect:
    """The prospect of one cell: it ends its task, does those that wait, then this order."""
    seconds = times.expected(order) + sum(times.expected(task.order) for task in run.queue)
    if run.task is not None:
        seconds += _remaining_s(run.task, run, times, now)
    return Prospect(
        order=order, seconds=seconds, hindrance=reasons.of_hindrance(run), is_full=run.queue.is_full
    )


def _remaining_s(task: Task, run: CellRun, times: PastTimes, now: float) -> float:
    """The time that a running task still needs, by its step; else by how long it has run."""
    remaining_s = times.remaining_s(task.order, run.run.steps)
    if remaining_s is not None:
        return remaining_s
    return max(times.expected(task.order) - (now - (task.started_at or now)), 0.0)


def best(prospects: Sequence[Prospect]) -> tuple[Order, Sentence]:
    """The order of the best prospect, and why it is the best; of equals the first."""
    chosen = min(prospects, key=lambda each: each.rank)
    others = tuple(_other(each) for each in prospects if each is not chosen)
    cell, seconds = chosen.order.cell, chosen.seconds
    if chosen.hindrance is None:
        return chosen.order, CHOSEN(cell=cell, seconds=seconds, others=others)
    why = chosen.hindrance
    return chosen.order, CHOSEN_IN_TROUBLE(cell=cell, seconds=seconds, others=others, why=why)


def _other(prospect: Prospect) -> Sentence:
    cell = prospect.order.cell
    if prospect.is_full:
        return FULL(cell=cell)
    if prospect.hindrance is not None:
        return HINDERED(cell=cell, why=prospect.hindrance)
    return LATER(cell=cell, seconds=prospect.seconds)
