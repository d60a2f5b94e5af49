"""Scopes of operators: the plant, a cell, or one robot."""

from __future__ import annotations

from arboleda.model.plant_model import Link, PlantModel

UNSENT = (Link.NONE, Link.SCREEN)  # nothing leaves the plant for these
NOBODY: tuple[str, ...] = ()


class Scopes:
    """Robots and cells of a scope as an operator writes it; none for any other word."""

    def __init__(self, model: PlantModel) -> None:
        cells = {cell.name: tuple(robot.name for robot in cell.robots) for cell in model.cells}
        everybody = tuple(model.robots)
        self._robots = {name: (name,) for name in everybody} | cells | {"": everybody, "plant": everybody}
        self._unsent = {name for name, robot in model.robots.items() if robot.link in UNSENT}
        self._cells = {cell.name: (cell.name,) for cell in model.cells}
        self._cells |= {robot: tuple(cell.name for cell in cells) for robot, cells in model.cells_of.items()}

    def robots(self, scope: str) -> tuple[str, ...]:
        return self._robots.get(scope.strip().lower(), NOBODY)

    def commanded(self, scope: str) -> set[str]:
        """The robots of a scope to which commands are sent."""
        return set(self.robots(scope)) - self._unsent

    def cells(self, scope: str) -> tuple[str, ...]:
        """The cells of a scope; for a shared device all cells that share it."""
        name = scope.strip().lower()
        names = [name] if name in self._cells else self.robots(scope)
        return tuple(dict.fromkeys(cell for each in names for cell in self._cells[each]))

    def __contains__(self, word: str) -> bool:
        return word.strip().lower() in self._robots
