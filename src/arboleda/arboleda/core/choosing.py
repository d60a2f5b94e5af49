"""Which cell does a task that several cells may do: the one that is expected to have done it first."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

from arboleda.model.messages import TaskState
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order, Task

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
LAST = 5  # of the times that a task took, those that count


class PastTimes:
    """How long tasks took that were done, as far as the plant remembers them."""

    def __init__(self, tasks: Iterable[Task]) -> None:
        self._took: dict[tuple[str, ...], deque[float]] = {}
        for task in tasks:
            if task.state is TaskState.DONE and task.started_at is not None and task.ended_at is not None:
                for key in _keys(task.order):
                    took = self._took.setdefault(key, deque(maxlen=LAST))
                    took.append(task.ended_at - task.started_at)

    def expected(self, order: Order) -> float:
        """The median of the last times that this very task took; else of its recipe in that cell, of its
        recipe in any cell, of whatever was done."""
        found = (self._took[key] for key in _keys(order) if key in self._took)
        took = next(found, None)
        return UNKNOWN_S if took is None else median(took)


def _keys(order: Order) -> tuple[tuple[str, ...], ...]:
    """What a time is kept for, the narrowest first."""
    if not order.recipe:
        return (("text", order.text), ("any",))
    of_recipe = (("cell", order.cell, order.recipe), ("recipe", order.recipe))
    return (("text", order.text), *of_recipe, ("any",))


@dataclass(frozen=True, kw_only=True)
class Prospect:
    """What a cell promises: in how many s it would have done an order, and what is in the way of that."""

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
    if run.task is not None and run.task.started_at is not None:
        seconds += max(times.expected(run.task.order) - (now - run.task.started_at), 0.0)
    return Prospect(order=order, seconds=seconds, hindrance=run.hindrance, is_full=run.is_full)


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
