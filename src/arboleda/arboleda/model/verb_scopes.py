"""Scopes of verbs as people name them: the plant, a cell, a robot or a task."""

from __future__ import annotations

from .messages import OperatorAnswer, OperatorRequest
from .plant_model import PlantModel
from .sentence import Phrase, Value
from .verbs import Scope

PLANT = Phrase("scope.plant", "plant")


def scopes(model: PlantModel) -> dict[str, frozenset[str]]:
    """The names of the robots of each scope: the plant, a cell, one robot."""
    robots = {name: frozenset([name]) for name in model.robots}
    cells = {cell.name: frozenset(robot.name for robot in cell.robots) for cell in model.cells}
    return robots | cells | dict.fromkeys(("", "plant"), frozenset(model.robots))


def scope_of(request: OperatorRequest | OperatorAnswer) -> str:
    """The scope that a request names; only task ids tell capitals apart."""
    scope = request.scope.strip()
    return scope if Scope.TASK in request.verb.row.scopes else scope.lower()


def whole(scope: str) -> Value:
    """A scope as sentences name it."""
    return scope or PLANT()
