"""Whom an operator means: the plant, a cell, or one robot."""

from __future__ import annotations

from arboleda.core.model import PlantModel

NOBODY: tuple[str, ...] = ()


class Scopes:
    """The robots and the cells of a scope as an operator writes it; none for any other word."""

    def __init__(self, model: PlantModel) -> None:
        cells = {cell.name: tuple(robot.name for robot in cell.robots) for cell in model.cells}
        everybody = tuple(model.robots)
        self._robots = {name: (name,) for name in everybody} | cells | {"": everybody, "plant": everybody}
        self._cell_of = {robot: cell.name for robot, cell in model.cell_of.items()}

    def robots(self, scope: str) -> tuple[str, ...]:
        return self._robots.get(scope.strip().lower(), NOBODY)

    def cells(self, scope: str) -> tuple[str, ...]:
        return tuple(dict.fromkeys(self._cell_of[robot] for robot in self.robots(scope)))

    def __contains__(self, word: str) -> bool:
        return word.strip().lower() in self._robots
