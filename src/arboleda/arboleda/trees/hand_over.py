"""Hand-over of shared devices: whether a device is idle, empty and at home, as cells leave it."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.plant_model import Cell


class HandOver:
    """State of the devices that one cell shares, as it matters for handing them on."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher, zones: Zones) -> None:
        self._cell = cell
        self._dispatcher = dispatcher
        self._zones = zones

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell

    def unused(self, devices: Iterable[str]) -> list[str]:
        """The devices of these that no cell holds and that do nothing, in order of their names."""
        free = [each for each in sorted(devices) if self._zones.holder(each) is None]
        return [each for each in free if not self._works(each)]

    def may_hold(self, device: str) -> bool:
        """True for a device in which a part may be."""
        effectors, robot = self._dispatcher.effectors, self._dispatcher.model.robots[device]
        return robot.held_fact is not None and effectors.grips.holding(device)

    def is_as_left(self, device: str) -> bool:
        """True for a shared device as cells leave it to each other: it holds no part, and is at home.

        A report of that proves nothing while the device may still grip, on a command that the plant gave up.
        """
        may_grip = self._dispatcher.unfinished.may_grip(device)
        return not may_grip and not self.may_hold(device) and self.is_home(device)

    def is_home(self, device: str) -> bool:
        """True for a shared robot that is seen at home, outside all zones; and for a device without poses."""
        space = self._cell.reach.get(device)
        if space is None:
            return True
        place = self._dispatcher.whereabouts.place(space)
        return place is not None and place.q == space.home.q and not self._zones.held_by(device)

    def may_change_hands(self, device: str) -> bool:
        """True for a shared device that is heard, idle, empty and at home, with its tool or robot."""
        together = self._cell.together({device})
        return all(self._does_nothing(each) and self.is_as_left(each) for each in together)

    def _does_nothing(self, device: str) -> bool:
        online = self._dispatcher.beliefs[device].online
        return online and not self._works(device) and device not in self._dispatcher.latches.stopped

    def _works(self, device: str) -> bool:
        moves = self._dispatcher.beliefs[device].moves
        return moves or bool(self._dispatcher.ledger.of_robot(device))
