"""Choice among cells that may do a task: the one that is expected to have done it first."""

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
UNKNOWN_S = 60.0  # what a task is taken to need where nothing like it was ever done
LAST = 5  # of the tasks that are alike, those that count
Key = tuple[str, ...]
ANY: Key = ("any",)


class PastTimes:
    """Times that tasks took which were done, as far as the plant remembers them."""

    def __init__(self, tasks: Iterable[Task]) -> None:
        self._done: dict[Key, deque[Task]] = {}
        for task in tasks:
            if task.state is TaskState.DONE and _took(task) >= 0:  # less where a clock was set back
                for key in (*_keys(task.order), ANY):
                    self._done.setdefault(key, deque(maxlen=LAST)).append(task)

    def expected(self, order: Order) -> float:
        """The median of the last times that this very task took; else of its recipe in that cell, of its
        recipe in any cell, of whatever was done."""
        alike = next((self._done[key] for key in (*_keys(order), ANY) if key in self._done), ())
        return median(map(_took, alike)) if alike else UNKNOWN_S

    def left(self, order: Order, steps: Sequence[tuple[str, float]]) -> float | None:
        """The expected rest of a task whose steps began so many s ago, the last one first: the
        median of what was left the last times that such tasks were where it is; None where none ever was.
        """
        for key in _keys(order):
            courses = [task.course for task in self._done.get(key, ()) if task.course is not None]
            for step, seconds in steps:
                found = [left for course in courses if (left := course.left(step, seconds)) is not None]
                if found:
                    return median(found)
        return None


def _keys(order: Order) -> tuple[Key, ...]:
    """The keys under which alike tasks are found, the most alike first."""
    if not order.recipe:
        return (("text", order.text),)
    return ("text", order.text), ("cell", order.cell, order.recipe), ("recipe", order.recipe)


def _took(task: Task) -> float:
    """Without the time for which it was held, where that is known."""
    if task.course is not None:
        return task.course.seconds
    return (task.ended_at or 0.0) - (task.started_at or 0.0)


@dataclass(frozen=True, kw_only=True)
class Prospect:
    """Promise of a cell: in how many s it would have done an order, and what is in the way of that."""

    order: Order
    seconds: float
    hindrance: Sentence | None
    is_full: bool

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """The lowest is the best."""
        return self.is_full, self.hindrance is not None, self.seconds


def prospect(order: Order, run: CellRun, times: PastTimes, now: float) -> Prospect:
    """That of one cell: what is left of its task, then those that wait, then this one."""
    seconds = times.expected(order) + sum(times.expected(task.order) for task in run.queue)
    if run.task is not None:
        seconds += _left(run.task, run, times, now)
    return Prospect(
        order=order, seconds=seconds, hindrance=reasons.of_hindrance(run), is_full=run.queue.is_full
    )


def _left(task: Task, run: CellRun, times: PastTimes, now: float) -> float:
    """The rest of the task that runs, by the step at which it is; where nothing is known of that, by how
    long it has run."""
    left = times.left(task.order, run.run.steps)
    if left is not None:
        return left
    return max(times.expected(task.order) - (now - (task.started_at or now)), 0.0)


def best(prospects: Sequence[Prospect]) -> tuple[Order, Sentence]:
    """The order of the best, and why it is; of equals the one that was named first."""
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
