"""Counts of parts at places on an operator's word: a person has taken parts out, or put some there."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.model.common_places import room_at, with_common_places
from arboleda.model.messages import OperatorRequest
from arboleda.model.outside import quoted
from arboleda.model.sentence import Phrase, Sentence, Value
from arboleda.model.verb_scopes import whole

from ..cell import CellRun
from ..plant_state import PlantState
from .scopes import Scopes, VerbRefusal

NO_STATION = Phrase("refusal.no_station", "{station} is not a station of {cell}")
STATION_EMPTY = Phrase("refusal.station_empty", "no part is known to be in station {station} of {cell}")
NO_PLACE = Phrase("refusal.no_place", "{place} is no place of {cell}; there are {known}")
NO_PLACES = Phrase("refusal.no_places", "{cell} has no places for parts; its plant file names none")
PLACE_EMPTY = Phrase("refusal.place_empty", "no part is known to be at {place} of {cell}")
PARTS_OF_PLACE = Phrase("refusal.parts_of_place", "{place} of {cell} holds 1 to {most} parts, not {parts}")
RACK_EMPTY = Phrase("refusal.rack_empty", "no part is known to be in the rack of {cell}")


class PartCounts:
    def __init__(self, state: PlantState, scopes: Scopes) -> None:
        self._state = state
        self._scopes = scopes

    def plan_unloading(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan to empty one place or station; without either, all places of the cells."""
        robots, place = self._scopes.robots(scope), request.argument("place")
        station = request.argument("station")
        cells = [cell for cell in self._with_places(scope) if robots & set(cell.cell.holders)]
        if place is not None:
            name = str(place).lower()
            cell = _with_place(cells, whole(scope), name)
            return self._planned_removal([(cell, [name])], PLACE_EMPTY(place=name, cell=cell.cell.name))
        if station is None:
            every = [(cell, [*cell.context.places.counts]) for cell in cells]
            return self._planned_removal(every, RACK_EMPTY(cell=whole(scope)))
        racks = [(cell, dict[Value, str](enumerate(cell.cell.station_targets))) for cell in cells]
        targets = [(cell, [rack[station]]) for cell, rack in racks if station in rack]
        if not targets:
            raise VerbRefusal(NO_STATION(station=quoted(str(station)), cell=whole(scope)))
        return self._planned_removal(targets, STATION_EMPTY(station=station, cell=whole(scope)))

    def plan_loading(self, request: OperatorRequest, scope: str) -> Callable[[], None]:
        """Plan to fill one place of a cell: with so many parts, else as full as it gets."""
        place, parts = str(request.argument("place") or "").lower(), request.argument("parts")
        cell = _with_place(self._with_places(scope), whole(scope), place)
        most = room_at(cell.cell, place, [each.cell for each in self._scopes.cells.values()])
        number = most if parts is None else parts
        if isinstance(number, str) or not 1 <= number <= most:
            amount = quoted(number) if isinstance(number, str) else number
            raise VerbRefusal(PARTS_OF_PLACE(place=place, cell=cell.cell.name, most=most, parts=amount))
        return partial(self._set_parts, [(cell, {place: number})])

    def _planned_removal(
        self, places: list[tuple[CellRun, list[str]]], refusal: Sentence
    ) -> Callable[[], None]:
        """Plan to empty these places; VerbRefusal where all are empty."""
        full = [cell.context.places.full.intersection(names) for cell, names in places]
        if not any(full):
            raise VerbRefusal(refusal)
        return partial(self._set_parts, [(cell, dict.fromkeys(names, 0)) for cell, names in places])

    def _with_places(self, scope: str) -> list[CellRun]:
        """The cells whose places a scope means: a cell alone, even where it shares devices with others."""
        robots, cells = self._scopes.robots(scope), self._scopes.cells
        return [cells[scope]] if scope in cells else self._scopes.of_robots(robots)

    def _set_parts(self, parts: list[tuple[CellRun, dict[str, int]]]) -> None:
        cells = self._scopes.cells
        numbers_by_cell = {cell.cell.name: numbers for cell, numbers in parts}
        everywhere = with_common_places(numbers_by_cell, [cell.cell for cell in cells.values()])
        for name, numbers in everywhere.items():
            cells[name].context.places.set(numbers)
        self._state.dispatcher.wake([*everywhere])


def _with_place(cells: list[CellRun], scope: Value, place: str) -> CellRun:
    """The cell with that place; VerbRefusal names the places that there are."""
    names = tuple(name for cell in cells for name in cell.context.places.counts)
    if not names:
        raise VerbRefusal(NO_PLACES(cell=scope))
    if place not in names:
        raise VerbRefusal(NO_PLACE(place=quoted(place), cell=scope, known=names))
    return next(cell for cell in cells if place in cell.context.places.counts)
