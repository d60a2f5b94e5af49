"""Devices that a cell shares with others: asked for, held, given back, and lost to a stop."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.messages import Fact, Failure, Reason
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Phrase

NOT_HELD = Phrase("device.not_held", "{cell} does not hold {device}, which cells share; nothing was sent")
OF_OTHER = Phrase("device.of_other", "{cell} does not hold {device}, which {holder} holds; nothing was sent")
NOT_RESET = Phrase(
    "device.not_reset", "{device} was stopped, and a cell that was stopped with it is not reset"
)


class CellDevices:
    """Shared devices of one cell; a cell holds one from the first step that commands it to the last."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher, zones: Zones) -> None:
        self._cell = cell
        self._dispatcher = dispatcher
        self._zones = zones

    def has(self, robot: str) -> bool:
        """True for a device that is the cell's now: its own, or a shared one that it holds."""
        return robot in self._cell.own or (robot in self._cell.shared and self.holds(robot))

    def holds(self, device: str) -> bool:
        """True while the cell holds a device that it shares."""
        return self._zones.holder(device) == self._cell.name

    def take(self, devices: frozenset[str]) -> bool:
        """Ask for shared devices, all at once; True once the cell has them.

        What a step that failed has left it goes back before: no cell waits for one while it holds another.
        """
        name = self._cell.name
        held = self._zones.held_by(name)
        if devices <= held:
            return True
        if held and not self.leave(held):
            return False
        if not self._zones.request(name, devices):
            return False
        self._dispatcher.memory.occupy(self._zones.held_by(name), name)
        return True

    def leave(self, devices: frozenset[str]) -> bool:
        """Stop waiting for shared devices, and give back those that are heard and do nothing; True once the
        cell holds none of them any more.
        """
        name = self._cell.name
        granted = self._zones.withdraw(name)
        held = self._zones.held_by(name) & devices
        quiet = frozenset(filter(self._does_nothing, held))
        if quiet:
            waiting = tuple(other for other, asked in self._zones.waiting if asked & quiet)
            granted += self._zones.give_back(quiet) + waiting  # who still waits names another holder now
            self._dispatcher.memory.vacate(quiet)
        self._dispatcher.wake(granted)
        return held == quiet

    def keep(self, device: str, *, ended: bool) -> None:
        """Quarantine a shared device that the cell holds while it is not heard; `ended`: what used it has
        come to its end, so it goes back.
        """
        if not self._dispatcher.beliefs[device].online:
            self._zones.quarantine_device(device)
        elif ended:
            self.leave(frozenset({device}))

    def awaited(self, devices: Iterable[str]) -> tuple[str, str, bool] | None:
        """The first of the devices that another cell holds, or asked for before this one; that cell, and True
        where it holds the device.
        """
        name, asked = self._cell.name, dict(self._zones.waiting)
        for device in sorted(devices):
            holder = self._zones.holder(device)
            if holder not in (None, name):
                return device, holder, True
            ahead = self._zones.ahead_of(name) if name in asked else ()
            if earlier := [other for other in ahead if device in asked[other]]:
                return device, earlier[0], False
        return None

    def is_stopped(self, device: str) -> bool:
        """True while a stop is not over: it is not cleared, or a cell of the device is not reset."""
        return self._dispatcher.memory.value(Fact.LATCH, device) is not None

    def not_reset(self, device: str) -> Failure | None:
        """Objection to any use of a shared device whose stop is cleared, but not over."""
        if device not in self._cell.shared or not self.is_stopped(device):
            return None
        return Failure(reason=Reason.STOPPED, sentence=NOT_RESET(device=device))

    def objection(self, device: str) -> Failure | None:
        """Objection to a command to a device that the cell does not hold, or whose stop is not over."""
        if device not in self._cell.shared:
            return None
        if (stop := self.not_reset(device)) is not None:
            return stop
        name, holder = self._cell.name, self._zones.holder(device)
        if holder == name:
            return None
        held = NOT_HELD if holder is None else partial(OF_OTHER, holder=holder)
        sentence = held(cell=name, device=device)
        return Failure(reason=Reason.ZONE_UNAVAILABLE, sentence=sentence)

    def _does_nothing(self, device: str) -> bool:
        belief = self._dispatcher.beliefs[device]
        works = belief.moves or bool(self._dispatcher.ledger.of_robot(device))
        return belief.online and not works and device not in self._dispatcher.latched
