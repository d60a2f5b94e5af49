"""Override of a quarantine: an operator answers for an empty zone, or a shared device that nobody uses."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from arboleda.model.errors import IllegalTransition
from arboleda.model.messages import OperatorRequest
from arboleda.model.sentence import Phrase

from ..plant_state import PlantState
from .scopes import Scopes, VerbRefusal

STILL_WORKS = Phrase(
    "refusal.still_works",
    "{robot} has not given up its work in {zone}; stop {cell}, then override {zone}",
)
STILL_USES = Phrase(
    "refusal.still_uses",
    "{cell} has not given up its work with {device}; stop {cell}, then override {device}",
)
GOES_BACK = Phrase(
    "refusal.goes_back",
    "{device} stays with {cell} until it is heard, holds no part and is at home; "
    "then it is free without an override",
)


class Overriding:
    """Override of zones and of devices that cells share."""

    def __init__(self, state: PlantState, scopes: Scopes) -> None:
        self._state = state
        self._scopes = scopes

    def plan(self, request: OperatorRequest, zone: str) -> Callable[[], None]:
        """Plan the override of a zone or a device that no task needs any more."""
        holder = self._state.zones.holder(zone)
        cell = self._scopes.cells.get(holder or "")
        if cell is not None and cell.tree is not None and self._state.zones.is_quarantined(zone):
            raise VerbRefusal(STILL_USES(cell=cell.cell.name, device=zone))
        if cell is not None and zone in cell.cell.shared and not self._is_left_anywhere(zone):
            raise VerbRefusal(GOES_BACK(device=zone, cell=cell.cell.name))
        cell_of = self._state.dispatcher.model.cell_of  # a holder of an earlier start may not be in it
        if holder in cell_of and self._state.zones.is_quarantined(zone) and self._works(holder):
            name = self._scopes.in_charge(holder).cell.name
            raise VerbRefusal(STILL_WORKS(robot=holder, zone=zone, cell=name))
        try:
            self._state.zones.require_quarantined(zone)
        except IllegalTransition as error:
            raise VerbRefusal(error.sentence) from error
        return partial(self._override, zone)

    def _override(self, zone: str) -> None:
        granted = self._state.zones.override(zone)
        self._state.dispatcher.memory.vacate([zone])
        self._state.dispatcher.wake({*granted, *self._state.zones.robbed})

    def _is_left_anywhere(self, device: str) -> bool:
        """True for a shared device that neither moves nor holds parts, so that any cell may have it next."""
        robot = self._state.dispatcher.model.robots[device]
        return not robot.goes and robot.held_fact is None

    def _works(self, arm: str) -> bool:
        """True where a tree may need the zones of an arm, or the arm moves without a tree, as it homes."""
        cell = self._scopes.in_charge(arm)
        moves = any(entry.is_work for entry in self._state.dispatcher.ledger.of_robot(arm))
        return moves or cell.tree is not None
