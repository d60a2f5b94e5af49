"""Promises of each cell just before somebody asked for a task that several of them can do.

`tasks_go_to_the_best_cell` finds by it a task that goes to the worst of its cells.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import median

from arboleda.engine import CellRun
from arboleda.engine.inspection import LAST, UNKNOWN_S, Task, tasks_of, time_of
from arboleda.model import text
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Course, Fact, TaskRequest, TaskState
from arboleda.recipes import Order, TextError
from arboleda.rig.world import World

from .courses import Courses
from .robots import KnownRobot
from .scopes import UNSENT

WORKS = (CellState.IDLE, CellState.EXECUTE)
STANDS = (CellState.HOLDING, CellState.HELD)


@dataclass(frozen=True, kw_only=True)
class Promise:
    """Promise of a cell: no room, an obstacle, and the seconds in which it would have done the task."""

    is_full: bool
    is_hindered: bool
    seconds: float

    @property
    def rank(self) -> tuple[bool, bool, float]:
        """Sort key: the lowest promise is the best."""
        return self.is_full, self.is_hindered, self.seconds


class Choices:
    """Promises by cell, for a request that came alone; none where the plant had nothing to choose.

    A cell counts as hindered by what its robots said and by its state; the step of its task is known from
    what was seen of its tree. The plant's own code that chooses is not asked.
    """

    def __init__(self, robots: Mapping[str, KnownRobot], courses: Courses) -> None:
        self._robots = robots
        self._courses = courses
        self.promises: dict[str, Promise] = {}

    def look(self, world: World) -> None:
        """Take down the promises of all cells before the plant hears the request."""
        self.promises = {}
        plant, requests = world.plant, world.moment.requests
        alone = len(requests) == 1 and not world.moment.reports and world.now < plant.next_deadline
        if not alone or not isinstance(requests[0], TaskRequest):
            return
        try:
            orders = text.alternatives(requests[0].text, world.offers)
        except TextError:
            return
        if len(orders) > 1 and orders[0].id not in tasks_of(plant):
            self.promises = {order.cell: self._promise(order, world) for order in orders}

    def _promise(self, order: Order, world: World) -> Promise:
        run = world.plant.cells[order.cell]
        past = [task for task in tasks_of(world.plant).values() if task.state is TaskState.DONE]
        ahead = [order, *(task.order for task in run.queue)]
        seconds = sum(_expected(each, past) for each in ahead)
        if run.task is not None and run.task.started_at is not None:
            left = self._left(run, past, world.now - world.plant.now)
            after = run.task.started_at + _expected(run.task.order, past) - world.now
            seconds += max(0.0, after) if left is None else left
        return Promise(
            is_full=len(run.queue) >= run.cell.queue_limit,
            is_hindered=self._is_hindered(run, world),
            seconds=seconds,
        )

    def _left(self, run: CellRun, past: list[Task], since_step_s: float) -> float | None:
        """The seconds left in past tasks like the running one, from its present step; None if unknown."""
        progress = self._courses.at_work.get(run.cell.name)
        if run.task is None or progress is None or progress.recovers:
            return None
        steps, now = progress.steps, time_of(run).now + (0.0 if run.state in STANDS else since_step_s)
        for alike in _alike(run.task.order, past)[:-1]:
            courses = [task.course for task in alike[-LAST:] if task.course]
            known = [step for step in steps if any(step in course.begun for course in courses)]
            if known:
                step = known[-1]
                with_it = [course for course in courses if step in course.begun]
                return median(_rest(course, step, now - steps[step]) for course in with_it)
        return None

    def _is_hindered(self, run: CellRun, world: World) -> bool:
        if run.state not in WORKS or run.queue.paused or run.not_ready is not None:
            return True
        now, epoch = world.plant.now, world.plant.epoch
        displaced = world.disk.facts.get(Fact.DISPLACED, {})  # the disk knows more of these than reports say
        return any(
            robot.name in displaced or self._robots[robot.name].is_unfit(now, epoch)
            for robot in run.cell.reached
            if robot.link not in UNSENT  # who is asked on a screen reports nothing
        )


def _expected(order: Order, past: list[Task]) -> float:
    """The usual seconds of the past tasks that are most like this order."""
    for alike in _alike(order, past):
        if alike:
            return median(_took(task) for task in alike[-LAST:])
    return UNKNOWN_S


def _alike(order: Order, past: list[Task]) -> tuple[list[Task], ...]:
    """Past tasks in groups, from those most like the order to all of them."""
    of_recipe = [task for task in past if order.recipe and task.order.recipe == order.recipe]
    in_cell = [task for task in of_recipe if task.order.cell == order.cell]
    return [task for task in past if task.order.text == order.text], in_cell, of_recipe, past


def _rest(course: Course, step: str, seconds: float) -> float:
    """The seconds left of a task `seconds` after a step began, but not more than at its next step."""
    began = course.begun[step]
    following = [at for at in sorted(course.begun.values()) if at > began] or [course.seconds]
    return max(course.seconds - began - seconds, course.seconds - following[0])


def _took(task: Task) -> float:
    if task.course is not None:
        return task.course.seconds
    assert task.started_at is not None and task.ended_at is not None
    return task.ended_at - task.started_at
