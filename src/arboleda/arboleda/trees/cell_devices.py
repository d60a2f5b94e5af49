"""Devices that a cell shares with others: asked for, held, given back, and lost to a stop."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.zones import Zones
from arboleda.model.commands import Command
from arboleda.model.messages import Fact, Failure, Reason
from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Phrase

from .hand_over import HandOver

NOT_HELD = Phrase("device.not_held", "{cell} does not hold {device}, which cells share; nothing was sent")
OF_OTHER = Phrase("device.of_other", "{cell} does not hold {device}, which {holder} holds; nothing was sent")
NOT_RESET = Phrase(
    "device.not_reset", "{device} was stopped, and a cell that was stopped with it is not reset"
)


class CellDevices:
    """Shared devices of one cell; a cell holds one from the first step that commands it to the last."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher, zones: Zones) -> None:
        self.hand_over = HandOver(cell, dispatcher, zones)
        self._cell = cell
        self._dispatcher = dispatcher
        self._zones = zones

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell
        self.hand_over.revise(cell)

    def has(self, robot: str) -> bool:
        """True for a device of the cell alone, and for a shared device that the cell holds."""
        return robot in self._cell.own or (robot in self._cell.shared and self.holds(robot))

    def answers_for(self, robot: str) -> bool:
        """True for a robot of the cell alone, for a shared robot that the cell holds, and for one that none
        holds while this is the first of its cells.
        """
        if robot not in self._cell.shared:
            return robot in self._cell.own
        holder = self.holder(robot)
        return holder == self._cell.name or (holder is None and self._is_first_of(robot))

    def is_lent(self, device: str) -> bool:
        """True for a device that another cell has."""
        return self.holder(device) not in (None, self._cell.name)

    def holder(self, device: str) -> str | None:
        """The cell that holds a shared device; None also where an earlier plant file had that cell."""
        holder = self._zones.holder(device)
        cells = [cell.name for cell in self._dispatcher.model.cells_of[device]]
        return holder if holder in cells else None

    def holds(self, device: str) -> bool:
        """True while the cell holds a device that it shares."""
        return self._zones.holder(device) == self._cell.name

    def held(self) -> frozenset[str]:
        """The shared devices that the cell holds."""
        return self._zones.held_by(self._cell.name)

    def take(self, devices: frozenset[str]) -> bool:
        """Ask for shared devices, all at once; True once the cell has them.

        The cell gives back others first, which a failed step has left it: no cell waits for a device while it
        holds another, so none waits for ever.
        """
        name, held = self._cell.name, self.held()
        if devices <= held:
            self._note_taken(devices)  # it may have got them while it waited
            return True
        if held and not self.leave(held):
            return False
        if not all(self._zones.holder(device) or self.hand_over.is_as_left(device) for device in devices):
            return False
        if not self._zones.acquire(name, devices):
            return False
        self._note_taken(devices)
        return True

    def claim(self, device: str) -> None:
        """Take a shared device that no other cell holds, wherever it stands, with its tool or robot."""
        together = self._cell.together({device})
        self._zones.claim(self._cell.name, together)
        self._note_taken(together)

    def _note_taken(self, devices: frozenset[str]) -> None:
        """Remember which cell has devices; effectors that opened before were another cell's matter."""
        memory, name = self._dispatcher.memory, self._cell.name
        for device in devices:
            if memory.value(Fact.QUARANTINE, device) != name:
                self._dispatcher.effectors.opened.pop(device, None)
        memory.occupy(devices, name)

    def leave(self, devices: frozenset[str]) -> bool:
        """Stop waiting for shared devices, and give back those that may change hands; True once all are back.

        A device is handed on heard, idle, empty and at home, since the next cell knows neither whose part it
        holds nor from where its way begins.
        """
        name = self._cell.name
        granted = self._zones.withdraw(name)
        held = self._zones.held_by(name) & devices
        quiet = frozenset(filter(self.hand_over.may_change_hands, held))
        if quiet:
            granted += self._zones.give_back(quiet)
            self._dispatcher.memory.vacate(quiet)
        self._dispatcher.wake(granted)
        return held == quiet

    def keep(self, device: str, *, ended: bool) -> None:
        """Quarantine a shared device of the cell while it is silent, or give it back: its use has `ended`."""
        if not self._dispatcher.beliefs[device].online:
            self._zones.quarantine_device(device)
        elif ended:
            self.leave(frozenset({device}))

    def awaited(self, devices: Iterable[str]) -> dict[str, str]:
        """The devices of these that another cell holds, each with that cell."""
        return self._zones.awaited(self._cell.name, devices)

    def asked_before(self) -> tuple[str, str] | None:
        """A device that the cell waits for, and the first of the cells that asked for it before."""
        return self._zones.queue.asked_before(self._cell.name)

    def is_stopped(self, device: str) -> bool:
        """True while a stop of a device is not over: it is not cleared, or one of its cells is not reset."""
        return self._dispatcher.memory.value(Fact.LATCH, device) is not None

    def not_reset(self, device: str) -> Failure | None:
        """Objection to any use of a shared device whose stop is cleared, but not over."""
        if device not in self._cell.shared or not self.is_stopped(device):
            return None
        return Failure(reason=Reason.STOPPED, sentence=NOT_RESET(device=device))

    def objection(self, command: Command) -> Failure | None:
        """Objection to a command to a device that the cell does not hold, or whose stop is not over."""
        device = command.robot
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

    def part_left_in(self, devices: Iterable[str]) -> str | None:
        """The first of the shared devices that the cell holds, and in which a part may be."""
        held = filter(self.holds, sorted(devices))
        return next(filter(self.hand_over.may_hold, held), None)

    def _is_first_of(self, robot: str) -> bool:
        return self._dispatcher.model.cell_of[robot].name == self._cell.name
