"""Numbers that tell the branches of recipes apart, as answers of simulated devices and in proofs.

Recipes in Python have ranges at their questions; trees of files compare variables with numbers in scripts.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.drivers import Value
from arboleda.engine import Plant
from arboleda.kinds.declared import QueryCall
from arboleda.kinds.ranges import Range, apart
from arboleda.model.orders import orders
from arboleda.model.plant_model import PlantModel
from arboleda.recipes.handles import Ask
from arboleda.recipes.of_files import FileRecipe

DeviceAndVerb = tuple[str, str]


def numbers(model: PlantModel) -> Mapping[DeviceAndVerb, tuple[Value, ...]]:
    """By device and verb of each question by a number: answers that tell the branches of all recipes apart.

    The first is what a virtual device answers.
    """
    devices: list[Any] = [robot for robot in model.robots.values() if robot.verb_names]
    verbs = [(device.name, verb) for device in devices for verb in device.kind.verbs.values()]
    types = {(device, verb.name): verb.number for device, verb in verbs if verb.number is not None}
    ranges = _ranges(model) if types else {}
    return {key: apart(type, ranges.get(key, ())) for key, type in types.items()}


def _ranges(model: PlantModel) -> dict[DeviceAndVerb, list[Range]]:
    """The ranges of all recipes of a plant, by device and verb of the question."""
    found: dict[DeviceAndVerb, list[Range]] = {}
    runs = Plant(model, epoch=0, now=0.0).cells
    for cell in model.cells:
        for recipe in cell.recipes:
            for order in orders(cell, recipe):
                tree = recipe.build(order, runs[cell.name].context)
                questions = [each for each in tree.iterate() if isinstance(each, Ask) and each.number]
                written = list(recipe.compared(tree)) if questions and isinstance(recipe, FileRecipe) else []
                for question in questions:
                    command = question.make(id="")
                    assert isinstance(command, QueryCall)
                    found.setdefault((command.robot, command.verb), []).extend((*question.ranges, *written))
    return found
