"""Record of what was told and carried out of each task over all starts of the plant.

`no_step_is_done_twice` finds by it a task that begins from its first step after a restart.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from operator import attrgetter

from py_trees.behaviour import Behaviour

from arboleda.drivers import Command, Motion, Query
from arboleda.engine.inspection import path_of
from arboleda.model.messages import ENDED, TaskChanged, TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.decorators import Again, Times
from arboleda.recipes.of_files import FileNode
from arboleda.wire.payloads import Goal

from ..truth.stops import is_order_of

UNDER_WAY = 16  # commands of a robot that may still reach its board
TURN = "turn"  # of a step in a tree of a file, the count of its begins
TASKS = 2000  # tasks that are followed; older ones are dropped


@dataclass(frozen=True, slots=True)
class Step:
    """A command that a step of a task gave: `start` is the number of the plant's start, `path` the step's
    place in the tree with the turn of what repeats it; `retries` is how often an operator had steps of its
    cell tried again by then. `misled`: its board may have lied by then about the commands that it had taken.
    """

    task: str
    path: str
    command: Command
    start: int
    retries: int
    misled: bool


class Starts:
    """Tasks over all starts: `changes` is the last word on each accepted one, `ended` its first end told.

    `before` has the last words of earlier starts, as they were when the plant started last.
    `wrong` are ends that were told again or otherwise in this step. `twice` are steps that a board has begun
    again although an earlier start had done them, or had gone on from them.
    """

    def __init__(self, model: PlantModel) -> None:
        self.changes: dict[str, TaskChanged] = {}
        self.before: dict[str, TaskChanged] = {}
        self.ended: dict[str, TaskChanged] = {}
        self.wrong: list[str] = []
        self.twice: list[str] = []
        self._model = model
        self._robots = {robot.mqtt: robot for robot in model.robots.values()}
        self._sent: dict[str, deque[Step]] = {name: deque(maxlen=UNDER_WAY) for name in model.robots}
        self._done: dict[tuple[str, str], list[Step]] = {}  # (task, robot) -> what its board carried out
        self._steps: dict[str, Step] = {}  # those that were given and have not ended, by their command
        self._over: dict[tuple[str, str], Step] = {}  # (task, path) -> a step from which the task went on
        self._given_up: deque[str] = deque(maxlen=TASKS)  # commands whose step may be given again

    def clear_news(self) -> None:
        """Clear the findings of the step before."""
        self.wrong.clear()
        self.twice.clear()

    def take_stock(self) -> None:
        """Note what was told so far, for a plant that starts and may say something in the same step."""
        self.before = dict(self.changes)

    def hear(self, messages: Iterable[object]) -> None:
        """Take in what the plant says, its last words too."""
        for message in messages:
            if isinstance(message, TaskChanged) and message.state is not TaskState.REFUSED:
                self._hear(message)

    def gave(self, step: Step) -> None:
        """Note a command that a step of a task gave."""
        over = self._over.get((step.task, step.path))
        if over is not None and over.start < step.start:
            self._again(step, over)
        self._steps[step.command.id] = step
        if not isinstance(step.command, Query):  # to ask once more changes nothing
            self._sent[step.command.robot].append(step)

    def went_on(self, command: str) -> None:
        """Note that the task went on from the step of this command, and that this was kept."""
        step = self._steps.pop(command, None)
        if step is not None:
            self._over[step.task, step.path] = step
            if len(self._over) > TASKS:
                del self._over[next(iter(self._over))]

    def gave_up(self, command: str) -> None:
        """Note that a command failed or was halted: its step may be given again, whatever its board did."""
        if self._steps.pop(command, None) is not None:
            self._given_up.append(command)

    def restart(self, *, undone: bool) -> None:
        """Begin another start of the plant; `undone`: what was kept last may be gone."""
        self._steps.clear()
        if undone:
            self._over.clear()

    def carries_out(self, board: str, goal: Goal) -> None:
        """Note that a board carries out a goal: it belongs to the newest of the commands that match it."""
        robot = self._robots.get(board)
        if robot is None:
            return
        sent = self._sent[robot.name]
        step = next((each for each in reversed(sent) if is_order_of(goal, robot, each.command)), None)
        if step is not None:
            sent.remove(step)
            self._carry_out(step)

    def _hear(self, change: TaskChanged) -> None:
        end = self.ended.get(change.task)
        if end is not None and (change.state is not end.state or change.request is None):
            before, now = end.state.value, change.state.value
            self.wrong.append(
                f"task {change.task} was told to have ended as {before}, and now as {now}"
                if change.state in ENDED
                else f"task {change.task} had ended as {before}, and is told to be {now}"
            )
        elif end is None and change.state in ENDED:
            self.ended[change.task] = change
        self.changes[change.task] = change
        if len(self.changes) > TASKS:
            oldest = next(iter(self.changes))
            del self.changes[oldest]
            self.ended.pop(oldest, None)

    def _carry_out(self, step: Step) -> None:
        done = self._done.setdefault((step.task, step.command.robot), [])
        before = [each for each in done if each.path == step.path and each.start < step.start]
        if before:
            before = [each for each in before if each.command.id not in self._given_up]
        if before and not step.misled and not _may_be_repeated(done, before[-1], step):
            self._again(step, before[-1])
        done.append(step)
        if len(self._done) > TASKS:
            del self._done[next(iter(self._done))]

    def _again(self, step: Step, before: Step) -> None:
        what = f"{type(step.command).__name__} {step.command.id}"
        self.twice.append(
            f"{what} does step {step.path} of task {step.task} again, as {before.command.id} did"
        )


def turn_of(leaf: Behaviour) -> str:
    """The path of a step in its tree, with the turn of each step around it that repeats it."""
    turns = turns_of(leaf)
    return f"{path_of(leaf)} in turn {turns}" if turns else path_of(leaf)


def turns_of(leaf: Behaviour) -> list[int]:
    """The turns of the repeating steps around a step, the outermost first."""
    turns, node = [], leaf.parent
    while node is not None:
        if (turn := _turn_in(type(node))) is not None:
            turns.append(turn(node))
        node = node.parent
    return turns[::-1]


@cache
def _turn_in(kind: type[Behaviour]) -> Callable[[Behaviour], int] | None:
    """The number of the turn in nodes of a class that repeats; in trees of files each step counts its own."""
    if issubclass(kind, FileNode):
        return attrgetter(TURN) if TURN in kind.counts else None
    counts = ((Times, "done"), (Again, "tries"))
    return next((attrgetter(count) for repeats, count in counts if issubclass(kind, repeats)), None)


def most_turns(leaf: Behaviour) -> float:
    """The most often that the steps around a step have it done, for one turn of what is around those."""
    most, node = 1.0, leaf.parent
    while node is not None:
        if isinstance(node, FileNode) and TURN in node.counts:
            return math.inf  # nodes of files may halt and begin one another
        if isinstance(node, Times | Again):
            most *= node.times + isinstance(node, Again)
        node = node.parent
    return most


def _may_be_repeated(done: list[Step], before: Step, again: Step) -> bool:
    """True if a step may be done anew after a restart: a motion cut short, or by an operator's retry."""
    interrupted = done[-1].path == again.path and isinstance(again.command, Motion)
    return interrupted or again.retries > before.retries
