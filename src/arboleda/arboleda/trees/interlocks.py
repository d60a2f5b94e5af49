"""Interlocks: the zones that a device without a workspace, as a door or a lift, may occupy."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.facts import Facts, shown
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Cell, Evidence


class Interlocks:
    """Reader of the interlocks of one cell; `reserved` has the zones that a task of an earlier start took."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher) -> None:
        self.reserved: Mapping[str, Sequence[str]] = {}
        self._cell = cell
        self._dispatcher = dispatcher

    def occupied_by(self, device: str) -> frozenset[str]:
        """The zones that a device may occupy: it reports not the contrary, or a command may lead it there.

        That is an open command, or a command that the plant gave up and the device may still carry out. A
        device that moves without work of this plant, or before it has taken that work, may be on its way into
        a zone. Reports that may be older than its last stop count for nothing.
        """
        belief = self._dispatcher.beliefs[device]
        may_come = [entry.command for entry in self._dispatcher.ledger.of_robot(device)]
        may_come += [command for command, _ in self._dispatcher.unfinished.by_device.get(device, ())]
        return frozenset(
            each.zone
            for each in self._cell.interlocks_of(device)
            if not belief.online
            or not belief.stillness.is_sure
            or (belief.state is MotionState.MOVING and not self._is_at_its_work(device))
            or any(belief.fact(name) != value for name, value in each.free_while)
            or any(map(each.is_ended_by, may_come))
        )

    def left_by(self, device: str, held: frozenset[str]) -> frozenset[str]:
        """The zones of these that a device does not occupy, and no task has reserved."""
        return held - self.occupied_by(device) - frozenset(self.reserved.get(device, ()))

    def in_the_way(self, device: str, zones: Iterable[str]) -> tuple[str, ...] | None:
        """The facts in words that `unreported` names."""
        facts = self.unreported(device, zones)
        return None if facts is None else tuple(f"{name} {shown(value)}" for name, value in facts)

    def unreported(self, device: str, zones: Iterable[str]) -> Facts | None:
        """The facts that a device at rest does not report, so that it occupies one of the zones.

        None where it is not heard, works, or occupies none of them.
        """
        belief = self._dispatcher.beliefs[device]
        wanted = self.occupied_by(device).intersection(zones)
        if not belief.online or belief.moves or self._dispatcher.ledger.of_robot(device) or not wanted:
            return None
        unsaid = [
            (name, value)
            for each in self._cell.interlocks_of(device)
            if each.zone in wanted
            for name, value in each.free_while
            if belief.fact(name) != value
        ]
        return tuple(dict.fromkeys(unsaid)) or None

    def _is_at_its_work(self, device: str) -> bool:
        """True while a device has work; a device that names its commands must have named it as taken."""
        work = self._dispatcher.ledger.work_of(device)
        names_commands = self._dispatcher.model.robots[device].evidence is Evidence.IDS
        return work is not None and (work.accepted_at is not None or not names_commands)

    def led_into(self, device: str, zones: Iterable[str]) -> frozenset[str]:
        """The zones that a device occupies once it has left these, as a lift between two of them."""
        locks = self._cell.interlocks_of(device)
        free = {name: value for each in locks if each.zone in zones for name, value in each.free_while}
        return frozenset(
            each.zone
            for each in locks
            if any(free.get(name, value) != value for name, value in each.free_while)
        )
