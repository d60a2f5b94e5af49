"""Numbers that tell the branches of recipes apart: as answers for `check`, simulated devices and proofs.

Recipes in Python have ranges at their questions; trees as XML compare variables with numbers in scripts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from py_trees.behaviour import Behaviour

from arboleda.engine import Plant
from arboleda.kinds.declared import Device, FactType, QueryCall
from arboleda.kinds.ranges import Range, apart, exactly
from arboleda.model.facts import Value
from arboleda.model.orders import orders
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.handles import Ask

from . import script
from .running.node import Node
from .running.scripts import Script, ScriptError, evaluate

DeviceAndVerb = tuple[str, str]


def numbers(model: PlantModel) -> Mapping[DeviceAndVerb, tuple[Value, ...]]:
    """By device and verb of each question by a number: answers that tell the branches of all recipes apart.

    The first is what a virtual device answers.
    """
    devices = [robot for robot in model.robots.values() if isinstance(robot, Device)]
    verbs = [(device.name, verb) for device in devices for verb in device.kind.verbs.values()]
    types = {(device, verb.name): verb.number for device, verb in verbs if verb.number is not None}
    ranges = _ranges(model) if types else {}
    return {key: apart(type, ranges.get(key, ())) for key, type in types.items()}


def numbers_for(type: FactType, node: Node) -> tuple[Value, ...]:
    """Answers by a number to the question of a node, which tell the branches of its tree apart."""
    return apart(type, _compared(_root(node)))


def _ranges(model: PlantModel) -> dict[DeviceAndVerb, list[Range]]:
    """The ranges of all recipes of a plant, by device and verb of the question."""
    found: dict[DeviceAndVerb, list[Range]] = {}
    runs = Plant(model, epoch=0, now=0.0).cells
    for cell in model.cells:
        for recipe in cell.recipes:
            for order in orders(cell, recipe):
                tree = recipe.build(order, runs[cell.name].context)
                questions = [each for each in tree.iterate() if isinstance(each, Ask) and each.number]
                written = list(_compared(tree)) if questions else []
                for question in questions:
                    command = question.make(id="")
                    assert isinstance(command, QueryCall)
                    found.setdefault((command.robot, command.verb), []).extend((*question.ranges, *written))
    return found


def _compared(tree: Behaviour) -> Iterator[Range]:
    """The numbers with which scripts of a tree compare something, as far as they are known in advance."""
    for node in tree.iterate():
        for each in _scripts(node):
            for operand in script.compared(each.statements):
                number = _constant(operand, node)
                if number is not None:
                    yield exactly(number)


def _scripts(node: Behaviour) -> Iterator[Script]:
    if isinstance(node, Node):
        own = getattr(node, "script", None)
        found = (*node.before.values(), *node.after.values(), own)
        yield from (each for each in found if isinstance(each, Script))


def _constant(operand: script.Expression, node: Behaviour) -> float | None:
    """The number that a part of a script has before the tree runs; None where it has none."""
    assert isinstance(node, Node)
    if script.writes([operand]):
        return None
    try:
        value = evaluate(operand, node.scope)
    except ScriptError:
        return None
    return None if isinstance(value, str) else value


def _root(node: Behaviour) -> Behaviour:
    while node.parent is not None:
        node = node.parent
    return node
