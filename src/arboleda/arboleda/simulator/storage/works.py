"""Record of the commands of each cell's task, compared with its recipe, written down here once more."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from arboleda.dispatch.ledger import State
from arboleda.kinds.arm import SetEffector
from arboleda.kinds.joints import MoveJoints
from arboleda.kinds.mobile import FollowPath
from arboleda.model.commands import Command
from arboleda.model.messages import ENDED, TaskState, Verb
from arboleda.model.plant_model import Pose
from arboleda.recipes.storage_layout import StorageLayout

from ..recorded.commands import SentCommand
from ..recorded.robots import KnownRobot
from ..recorded.tasks import Tasks
from .tasks import is_storage_task

ROUNDING_S = 1e-6
OPTIONAL, TO_START = "maybe", "to the start"
# what is commanded, and where to; OPTIONAL: an attempt to grip that may be needed; TO_START: some way there
Step = tuple[str, Any]


@dataclass
class Work:
    """A task that runs: its steps, how many of them were commanded, and the `last` command.

    `walked_back`: an earlier start gave `last`, and the plant judges what became of it. `undone`: a power cut
    may have undone the task's step in memory; `retries` counts operators' retries up to that record.
    `doubtful`: `last` was either of two steps in a row that command this, so it may come once more.
    """

    task: str
    steps: list[Step]
    began_at: float
    at: int = 0
    last: SentCommand | None = None
    recovering: bool = False
    walked_back: bool = False
    doubtful: Step | None = None
    undone: bool = False
    retries: int = 0


class Works:
    """Work of every cell; `wrong` are sentences on commands of this step that do not follow the recipe."""

    def __init__(self, cells: dict[str, Any], robots: dict[str, KnownRobot]) -> None:
        self.wrong: list[str] = []
        self._cells = cells
        self._robots = robots
        self._works: dict[str, Work] = {}

    def restart(self, running: Mapping[str, str], *, undone: bool) -> None:
        """Begin a start of the plant in which these tasks stand at their steps; nobody goes on with others.

        `undone`: what was kept last may be gone.
        """
        self._works = {name: work for name, work in self._works.items() if running.get(name) == work.task}
        for name, work in self._works.items():
            work.walked_back, work.undone = True, work.undone or undone
            work.retries = self._cells[name].retries

    def follow(self, tasks: Tasks, new: list[SentCommand], now: float) -> None:
        """Take over what this step began, commanded and ended."""
        for change in tasks.changes:
            report = change.message
            if report.state is TaskState.RUNNING and not change.answer and report.cell in self._cells:
                cell = self._cells[report.cell].layout
                if not is_storage_task(cell.cell, report.text):
                    continue
                steps = list(_steps(cell, report.text.split()))
                self._works[report.cell] = Work(report.task, steps, now)
        for sent in new:
            if sent.entry is not None and sent.entry.cell in self._works and not _by_operator(sent):
                self._take(sent.entry.cell, sent)
        for change in tasks.changes:
            report = change.message
            if report.cell is not None and not change.answer and report.state in ENDED:
                work = self._works.get(report.cell)
                if work is not None and work.task == report.task:
                    del self._works[report.cell]
                    if report.state is TaskState.DONE and not self._is_anywhere(report.cell, work):
                        self._finished(report.cell, work)

    def _take(self, name: str, sent: SentCommand) -> None:
        cell, work = self._cells[name], self._works[name]
        work.recovering |= cell.run.run.recovering
        if work.recovering:
            return
        if self._is_anywhere(name, work):
            del self._works[name]
            return
        step = _step_of(sent.command)
        last, walked_back = work.last, work.walked_back
        work.walked_back = False
        work.undone = False
        again = last is not None and (walked_back or last.state is not State.DONE)
        if again and self._repeats(work, step, walked_back=walked_back):
            work.last = sent
            return
        if again and not walked_back:
            self.wrong.append(f"{name}: {sent} leaves, and {last} before it was not done")
        doubtful, work.doubtful = work.doubtful, None
        if step == doubtful and not (work.at < len(work.steps) and _fits(step, work.steps[work.at])):
            work.last = sent
            return
        if again and step is not None and _fits(step, work.steps[work.at - 1]):
            work.doubtful = step
        if self._stands_at_start(name, work, step):
            work.at += 1
        while work.at < len(work.steps) and not _fits(step, work.steps[work.at]):
            if work.steps[work.at][0] != OPTIONAL:
                expected = work.steps[work.at]
                self.wrong.append(f"{name}: {sent} is {step}, by the recipe it is {expected}'s turn")
                return
            work.at += 1
        if work.at == len(work.steps):
            self.wrong.append(f"{name}: {sent} comes after the last step of the recipe")
            return
        self._in_time(name, work, sent)
        work.at += 1
        work.last = sent

    @staticmethod
    def _repeats(work: Work, step: Step | None, *, walked_back: bool) -> bool:
        """True if a command is the last step once more, and not the next one.

        Two steps in a row may command the same: a cell may rest where it picks up, a path may end where it
        begins. What an earlier start commanded may have been done, so that the next step is as good.
        """
        before = work.steps[work.at - 1]
        if work.at < len(work.steps) and step == work.steps[work.at]:
            return not walked_back and _fits(step, before)
        return _is_again(step, before)

    def _stands_at_start(self, name: str, work: Work, step: Step | None) -> bool:
        """True if the path comes without the way to its start, as its robot has said that it stands there,
        or never says where it stands.
        """
        expected, after = [*work.steps[work.at : work.at + 2], ("", None), ("", None)][:2]
        if expected[0] != TO_START or step != after:
            return False
        return self._robots[self._cells[name].layout.mobile.name].node in (None, expected[1])

    def _is_anywhere(self, name: str, work: Work) -> bool:
        """True if the task may stand at a step too early, by a power cut, and a person had it tried again."""
        return work.undone and self._cells[name].retries > work.retries

    def _in_time(self, name: str, work: Work, sent: SentCommand) -> None:
        since = work.began_at if work.last is None else -1.0
        if work.last is not None and isinstance(work.last.command, SetEffector):
            since = work.last.at
        if since >= 0 and sent.at < since + self._cells[name].timing.dwell_s - ROUNDING_S:
            self.wrong.append(f"{name}: {sent} leaves {sent.at - since:.3f} s after what it has to wait for")

    def _finished(self, name: str, work: Work) -> None:
        left = [step for step in work.steps[work.at :] if step[0] != OPTIONAL]
        if left:
            self.wrong.append(f"{name}: {work.task} is done, and {left} were never commanded")
        if work.last is not None and work.last.state is not State.DONE and not work.walked_back:
            self.wrong.append(f"{name}: {work.task} is done, and {work.last} is not")


def _by_operator(sent: SentCommand) -> bool:
    """True for a command of an operator, no step's: a homing, or a release that opens the effector."""
    step = _step_of(sent.command)
    return step is None or (Verb.RELEASE in sent.verbs and step == ("effector", False))


def _step_of(command: Command) -> Step | None:
    if isinstance(command, MoveJoints):
        return "move", command.q
    if isinstance(command, FollowPath):
        return "path", command.nodes
    return ("effector", command.on) if isinstance(command, SetEffector) else None


def _fits(step: Step | None, expected: Step) -> bool:
    """True if a command is the expected step; a path must be given as a whole."""
    if step is None:
        return False
    if expected[0] == OPTIONAL:
        return bool(step == expected[1])
    if expected[0] == TO_START:
        return bool(step[0] == "path" and step[1][-1] == expected[1])
    return step == expected


def _is_again(step: Step | None, expected: Step) -> bool:
    """True if a command repeats a step that was not done; a path may begin where the robot is by then."""
    return _fits(step, expected) or (step is not None and step[0] == "path" and expected[0] == "path")


def _steps(cell: StorageLayout, words: list[str]) -> Iterator[Step]:
    """The steps that a task of this text commands, in order; its robot may stand at the start of its path."""
    if words[1] == "palletizing":
        yield "move", cell.home.q
        yield from _at(cell.palletizing.pick, list(_grip(cell)))
        yield from _at(cell.palletizing.place, [("effector", False)])
        return
    nodes = cell.path(words[1]).nodes
    pickup = cell.pickup_of(cell.path(words[1]))
    if cell.cell.drive_to_start:
        yield TO_START, nodes[0]
    yield "path", nodes
    yield from _at(pickup, list(_grip(cell)))
    yield from _at(cell.stations[int(words[2])], [("effector", False)])
    yield from _at(cell.home, [])


def _at(pose: Pose, work: list[Step]) -> Iterator[Step]:
    above = [("move", pose.above)] if pose.above is not None else []
    yield from (*above, ("move", pose.q), *work, *above)


def _grip(cell: StorageLayout) -> Iterator[Step]:
    yield "effector", True
    for _ in range(cell.cell.retry.times if cell.cell.piece_check is not False else 0):
        yield OPTIONAL, ("effector", False)
        yield OPTIONAL, ("effector", True)
