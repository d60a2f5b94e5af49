"""Invariant of drawn recipes: whichever form they have, their tasks tell devices what was drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

from arboleda.drivers import Command
from arboleda.engine.inspection import tasks_of
from arboleda.kinds.declared import VerbCall
from arboleda.model.messages import OperatorRequest, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import Cell
from arboleda.model.task import Task
from arboleda_proofs.simulator.invariants.invariant import Invariant, Look, Trigger
from arboleda_proofs.simulator.recorded.commands import SentCommand

from .devices.meaning import Meaning, Told, Unsure, plain
from .devices.steps import Param, Recipe, Tell, Value, walk

ENDS = (TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED)
HARMLESS = (Verb.ANSWER, Verb.LOAD, Verb.UNLOAD)
NAME = "recipes_do_what_was_drawn"
SENTENCE = """A task of a drawn recipe that is called done, before anything went wrong, has told each device
    what was drawn, in that order, and has waited as long, in Python as in a tree of a file; one that
    was drawn to fail fails with the words of that step. Whatever goes wrong, none tells a device what no
    recipe has."""
JITTER_S = 0.05


def as_drawn(recipes: Sequence[Recipe], *, pauses: bool = True) -> Invariant:
    """The invariant for a plant with these recipes; `pauses`: their form can say that a retry has a pause."""
    return Invariant(NAME, SENTENCE, Trigger.STEPPED, DrawnTasks(recipes, pauses=pauses).look)


class DrawnTasks:
    """Book of what the running task of each cell has told its devices."""

    def __init__(self, recipes: Sequence[Recipe], *, pauses: bool) -> None:
        self._recipes = recipes
        self._pauses = pauses
        self._names = {each.name for each in recipes}
        steps = (step for each in recipes for step in walk(each.step) if isinstance(step, Tell))
        self._drawn = {(each.role, *_pattern(each)) for each in steps}
        self._sent: dict[str, list[SentCommand]] = {}  # by cell
        self._is_disturbed = False

    def look(self, look: Look) -> Iterator[str]:
        """Take in a step: each breach in a sentence."""
        yield from self._undrawn(look)
        requests = [each for each in look.moment.requests if isinstance(each, OperatorRequest)]
        self._is_disturbed |= any(each.verb not in HARMLESS for each in requests)
        if self._is_disturbed or look.world.last_fault_at > -math.inf:
            return
        for sent in look.record.commands.new:
            if sent.entry is not None and isinstance(sent.command, VerbCall):
                self._sent.setdefault(sent.entry.cell, []).append(sent)
        for change in look.record.tasks.changes:
            if not change.answer and change.message.state in ENDS:
                yield from self._ended(look, change.message)

    def _undrawn(self, look: Look) -> Iterator[str]:
        """Orders for tasks of drawn recipes that no recipe has."""
        for sent in look.record.commands.new:
            if sent.entry is None or not isinstance(sent.command, VerbCall):
                continue
            if look.truth.released(sent.robot):
                continue  # an operator has it let go of what it holds
            cell, tasks = look.world.model.cell(sent.entry.cell), tasks_of(look.world.plant)
            task = tasks.get(look.record.tasks.running.get(cell.name, ""))
            if task is None or task.order.recipe not in self._names or sent.robot in _tools(cell):
                continue
            role = next(role for role, robot in cell.roles.items() if robot.name == sent.robot)
            verb, values = _order(sent.command)
            known = [rest for *named, rest in self._drawn if named == [role, verb]]
            if not any(map(partial(_fits, values), known)):
                yield f"{task.id} tells {role} {verb} {values}, which no recipe has"

    def _ended(self, look: Look, change: TaskChanged) -> Iterator[str]:
        cell, task = look.world.model.cell(change.cell or ""), tasks_of(look.world.plant).get(change.task)
        sent = self._sent.pop(cell.name, [])
        if cell.name in look.record.tasks.running:  # the next one has begun in this step
            self._sent[cell.name] = [each for each in sent if each in look.record.commands.new]
            sent = [each for each in sent if each not in look.record.commands.new]
        if task is None or change.state is TaskState.CANCELLED or task.order.recipe not in self._names:
            return
        drawn = _meaning(self._recipes, cell, task, sent, pauses=self._pauses)
        try:
            succeeds = drawn.run(task.order.recipe, task.order.values)
        except Unsure:
            return
        if change.state is TaskState.FAILED:
            words = f"{change.sentence} {task.failed_step or ''}"  # of a tree as XML the node has them
            if not succeeds and drawn.cause is not None and drawn.cause not in words:
                yield f"{change.task} is said to have failed ({words}), and was drawn to: {drawn.cause}"
            return
        if not succeeds:
            yield f"{change.task} of {task.order.recipe} is called done, and was drawn to fail"
        tools = _tools(cell)
        roles = [role for role, robot in cell.roles.items() if robot.name not in tools]
        yield from _differences(change.task, roles, _calls(cell, sent), drawn.orders)
        took_s = (task.ended_at or 0.0) - (task.started_at or 0.0)
        if took_s < drawn.seconds - JITTER_S:
            least = f"was drawn to wait {drawn.seconds:g} s"
            yield f"{change.task} is called done after {took_s:g} s, and {least}"


def _meaning(
    recipes: Sequence[Recipe], cell: Cell, task: Task, sent: Sequence[SentCommand], *, pauses: bool
) -> Meaning:
    """Reader of the recipe of a task, by what was answered to it."""
    roles = {robot.name: role for role, robot in cell.roles.items()}
    answers: dict[str, list[Value]] = {}
    for each in task.answers:
        answers.setdefault(roles.get(each.by, each.by), []).append(plain(each.answer))

    def takes_s(role: str, call: Told) -> float:
        mine = [each.command for each in sent if roles[each.robot] == role]
        alike = (each for each in mine if isinstance(each, VerbCall) and _order(each) == call)
        return max((each.takes_s for each in alike), default=0.0)

    return Meaning(recipes, answers, takes_s, pauses=pauses)


def _tools(cell: Cell) -> set[str]:
    """The devices of a cell that are told by grips."""
    return {space.tool.name for space in cell.spaces if space.tool is not None}


def _calls(cell: Cell, sent: Sequence[SentCommand]) -> dict[str, list[Told]]:
    """The calls to each role, in that order."""
    roles = {robot.name: role for role, robot in cell.roles.items()}
    found: dict[str, list[Told]] = {}
    for each in sent:
        found.setdefault(roles[each.robot], []).append(_order(each.command))
    return found


def _differences(
    task: str, roles: Sequence[str], calls: dict[str, list[Told]], orders: dict[str, list[Told]]
) -> Iterator[str]:
    for role in roles:
        if (given := calls.get(role, [])) != (wanted := orders.get(role, [])):
            yield f"{task} is called done; {role} was told {given}, and {wanted} was drawn"


def _fits(values: Sequence[Value], pattern: Sequence[Value | None]) -> bool:
    return all(wanted in (value, None) for value, wanted in zip(values, pattern, strict=True))


def _pattern(step: Tell) -> tuple[str, tuple[Value | None, ...]]:
    """A verb and its values as `_order` has them; None for that of a parameter, which may be any."""
    given = dict(step.values)
    values = (None if isinstance(given[name], Param) else plain(given[name]) for name in sorted(given))
    return step.verb, tuple(values)


def _order(command: Command) -> Told:
    assert isinstance(command, VerbCall)
    return command.verb, tuple(plain(value) for _, value in sorted(command.values))
