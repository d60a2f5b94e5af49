"""Facts by which a task can see whether work was done, and the steps of a recipe that ask for them."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour

from arboleda.engine import Act
from arboleda.model.commands import Command, Motion, Query
from arboleda.model.facts import shown
from arboleda.model.plant_model import Cell, Robot
from arboleda.plant_file.declared_kinds import verbs_of
from arboleda.recipes.handles import FactCheck, FactWait
from arboleda.recipes.of_files import FileNode

ANSWER = "=answer"  # in place of a fact: the answer to a question
DeviceFact = tuple[str, str]


def facts_that_tell(command: Command, cell: Cell) -> set[DeviceFact]:
    """The facts of its device by which the command can be seen: those that it sets.

    Of a command that sets none, any fact may tell that no verb sets, and any answer.
    """
    if command.sets:
        return {(command.robot, fact) for fact, _ in command.sets}
    device = _device(cell, command.robot)
    set_by_verbs = {name for verb in verbs_of(device).values() for name, _ in verb.sets}
    return {(device.name, fact) for fact in (ANSWER, *device.fact_names) if fact not in set_by_verbs}


def facts_asked(node: Behaviour, cell: Cell) -> Iterator[DeviceFact]:
    """The facts without which a step fails, or waits, or which it stores."""
    if isinstance(node, FactCheck | FactWait):
        yield from ((node.device, fact) for fact in node.facts)
    elif isinstance(node, FileNode):
        yield from node.facts.values()
    elif isinstance(node, Act):
        yield from _needed(node.make(id=""), cell)


def _needed(command: Command, cell: Cell) -> Iterator[DeviceFact]:
    """The facts that a command needs, of its device, of others, and on its way; the answer to a question."""
    yield from ((command.robot, fact) for fact, _ in command.needs)
    for need in cell.needs:
        if (need.device, need.word) == (command.robot, command.word):
            yield need.other, need.fact
    if isinstance(command, Query):
        yield command.robot, ANSWER
    if isinstance(command, Motion) and command.robot in cell.reach:
        zones = {zone for pose in cell.reach[command.robot].poses for zone in pose.zones}
        for lock in (each for each in cell.interlocks if each.zone in zones):
            yield from ((lock.device, fact) for fact, _ in lock.free_while)


def question_about(command: Command, cell: Cell) -> str:
    """The words that tell a person to ask for what a command sets, as a node of a tree."""
    role = next(role for role, device in cell.members if device.name == command.robot)
    facts = " ".join(f'{fact}="{shown(value)}"' for fact, value in command.sets)
    return f"write <{role}_says {facts}/>" if facts else f"ask {command.robot}"


def _device(cell: Cell, name: str) -> Robot:
    return next(each for each in cell.robots if each.name == name)
