"""Scopes of operators: the plant, a cell, or one robot."""

from __future__ import annotations

from collections.abc import Mapping

from arboleda.model.common_places import room_at
from arboleda.model.messages import OperatorAnswer, OperatorRequest, Verb
from arboleda.model.plant_model import Cell, Link, Place, PlantModel

UNSENT = (Link.NONE, Link.SCREEN)  # nothing leaves the plant for these
NOBODY: tuple[str, ...] = ()


class Scopes:
    """Robots and cells of a scope as an operator writes it; none for any other word."""

    def __init__(self, model: PlantModel) -> None:
        self._model = model
        cells = {cell.name: tuple(robot.name for robot in cell.robots) for cell in model.cells}
        self._cells: dict[str, tuple[str, ...]] = {cell.name: (cell.name,) for cell in model.cells}
        everybody = tuple(model.robots)
        self._robots = {name: (name,) for name in everybody} | cells | {"": everybody, "plant": everybody}
        self._unsent = {name for name, robot in model.robots.items() if robot.link in UNSENT}

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

    def parts(self, message: OperatorRequest | OperatorAnswer) -> dict[str, dict[str, int]]:
        """The parts that are at places, by cell, as somebody says with `load` or `unload`; for any scope."""
        arguments, found = dict(message.arguments), dict[str, dict[str, int]]()
        robots = set(self.robots(message.scope))
        for cell in map(self._model.cell, self.cells(message.scope)):
            places = _named(cell, arguments)
            if not places or (message.verb is Verb.UNLOAD and robots.isdisjoint(cell.holders)):
                continue
            full, parts = message.verb is Verb.LOAD, arguments.get("parts")
            found[cell.name] = {each.target: self._said(cell, each, parts) if full else 0 for each in places}
            if "place" in arguments:
                break
        return found

    def _said(self, cell: Cell, place: Place, parts: int | str | None) -> int:
        return room_at(cell, place.target, self._model.cells) if parts is None else int(parts)

    def __contains__(self, word: str) -> bool:
        return word.strip().lower() in self._robots


def _named(cell: Cell, arguments: Mapping[str, int | str]) -> list[Place]:
    """The places of a cell that the arguments of a verb name: one, a station, or all."""
    if "place" in arguments:
        return [each for each in cell.counted if each.target == str(arguments["place"]).lower()]
    if "station" not in arguments:
        return [*cell.counted]
    stations: dict[object, str] = dict(enumerate(cell.station_targets))
    return [each for each in cell.counted if each.target == stations.get(arguments["station"])]
