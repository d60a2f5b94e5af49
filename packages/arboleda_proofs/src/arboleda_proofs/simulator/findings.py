"""Findings of a run without faults: tasks that fail, and commands that are refused."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from enum import Enum

from arboleda.engine import Entry, State
from arboleda.engine.inspection import EMPTY, not_given_count_of, tasks_of, trouble_in
from arboleda.model.messages import Reason, TaskChanged, TaskState
from arboleda.recipes import Sentence
from arboleda.recipes.authoring import FAIL
from arboleda.recipes.decorators import RESCUE_FAILED
from arboleda.recipes.of_files import FAILED as TREE_FAILED
from arboleda.recipes.of_files import FAILED_AT as TREE_FAILED_AT
from arboleda.recipes.of_files import FAILS
from arboleda.recipes.place_questions import NO_PART_YET, NO_ROOM_YET
from arboleda.rig.world import World

from .record import Record
from .truth.refused_commands import RefusedCommands

AS_WRITTEN = (FAIL.key, FAILS.key)  # steps that do nothing but fail
UP_TO_OTHERS = (NO_PART_YET.key, NO_ROOM_YET.key)  # waits for what another task brings, or takes
BY_PEOPLE = frozenset({Reason.STOPPED, Reason.CANCELLED, Reason.INTERRUPTED})
BY_TREE = frozenset({TREE_FAILED.key, TREE_FAILED_AT.key})
REFUSALS = frozenset({Reason.REJECTED, Reason.PRECONDITION})


class FindingKind(str, Enum):
    """Kind of a finding; its words are those of the summary."""

    TASK = "task failed"
    COMMAND = "command refused"


@dataclass(frozen=True, kw_only=True)
class Finding:
    """Finding of a recipe: the step, the reason, and one of the sentences with which it was told, with the
    task of which it was told and the seed of that.
    """

    kind: FindingKind
    recipe: str
    step: str
    reason: str
    sentence: str = field(compare=False)
    task: str = field(compare=False, default="")
    seed: int | None = field(compare=False, default=None)


class Findings:
    """Counter of what is found in the recipes of a plant, as long as no fault has come.

    `as_written` counts failures that a recipe asks for: by `cell.fail`, or `AlwaysFailure` of a tree, in a
    task in which a device or a person has answered, for answers are drawn. Tasks of recipes that come with
    Arboleda have an invariant of their own, and what a person has ended is none. Neither is a wait for a
    place that ended in vain once `nobody_asks` for tasks any more.
    """

    def __init__(self, world: World, record: Record) -> None:
        self.found: Counter[Finding] = Counter()
        self.as_written: Counter[Finding] = Counter()
        self.nobody_asks = False
        self._world = world
        self._record = record
        self._refused_commands = RefusedCommands()
        self._refused: dict[str, list[Finding]] = {}  # by cell, of the task that runs there
        self._recipes: dict[str, str] = {}  # by cell, of the same task
        self._tasks: dict[str, str] = {}  # by cell, its text

    def look(self) -> None:
        """Take in a step; no fault has come until then."""
        record, plant = self._record, self._world.plant
        refused = self._refused_commands.fresh(plant) if not_given_count_of(plant) else []
        if refused or record.tasks.changes or record.commands.moved:
            self._take_in(refused)

    def _take_in(self, refused: list[Entry]) -> None:
        changes = [change.message for change in self._record.tasks.changes if not change.answer]
        for task_change in changes:
            if task_change.state is TaskState.RUNNING and task_change.cell not in self._recipes:
                self._began(task_change)
        for entry in refused:
            self._refuse(entry)
        for sent, _ in self._record.commands.moved:
            if sent.entry is not None and sent.entry.state is State.FAILED:
                self._refuse(sent.entry)
        for task_change in changes:
            self._follow(task_change)

    def _began(self, change: TaskChanged) -> None:
        self._recipes[change.cell or ""] = tasks_of(self._world.plant)[change.task].order.recipe
        self._tasks[change.cell or ""] = change.text

    def _follow(self, change: TaskChanged) -> None:
        if change.state is TaskState.RUNNING:
            self._began(change)
        elif change.state in (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED):
            self._ended(change)

    def _refuse(self, entry: Entry) -> None:
        failure, recipe = entry.failure, self._recipes.get(entry.cell)
        if entry.too_early or failure is None or failure.reason not in REFUSALS or recipe is None:
            return
        step = f"{entry.command.robot}: {entry.doing}"
        self._refused.setdefault(entry.cell, []).append(
            Finding(
                kind=FindingKind.COMMAND,
                recipe=recipe,
                step=step,
                reason=failure.reason.value,
                sentence=str(failure.sentence),
                task=self._tasks.get(entry.cell, ""),
            )
        )

    def _ended(self, change: TaskChanged) -> None:
        recipe = self._recipes.pop(change.cell or "", None)
        refused = self._refused.pop(change.cell or "", [])
        if recipe is None or self._world.model.cell(change.cell or "").recipe(recipe).is_shipped:
            return
        failed = change.state is TaskState.FAILED and change.reason not in BY_PEOPLE
        if self.nobody_asks and change.sentence.key in UP_TO_OTHERS:
            failed = False
        if failed:
            self._failed(recipe, change)
        sentence = str(change.sentence)
        self.found.update(each for each in refused if not (failed and each.sentence == sentence))

    def _failed(self, recipe: str, change: TaskChanged) -> None:
        task = tasks_of(self._world.plant)[change.task]
        step = task.failed_step
        by_itself = (step is not None and step.key in AS_WRITTEN) or change.sentence.key in BY_TREE
        is_whole = change.sentence.key != RESCUE_FAILED.key
        counted = self.as_written if by_itself and is_whole and task.answers else self.found
        counted[
            Finding(
                kind=FindingKind.TASK,
                recipe=recipe,
                step="" if step is None else str(step),
                reason="" if change.reason is None else change.reason.value,
                sentence=_advised(change.sentence),
                task=change.text,
            )
        ] += 1


def _advised(sentence: Sentence) -> str:
    """The sentence, with what a recipe can do instead where a place has no part, or no room."""
    trouble = trouble_in(sentence)
    if trouble is None:
        return str(sentence)
    place = f'cell.place("{trouble.values["place"]}")'
    if trouble.key == EMPTY.key:
        return (
            f"{sentence}; a recipe can wait for a part there: {place}.gets_part(...), in XML place_gets_part"
        )
    return f"{sentence}; a recipe can wait for room there: {place}.gets_room(...), in XML place_gets_room"
