"""Interlocks: the zones that a device without a workspace of its own may be in the way of."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.facts import shown
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Cell, Evidence


class Interlocks:
    """Reader of the interlocks of one cell; `reserved` has what a task of an earlier start took for them."""

    def __init__(self, cell: Cell, dispatcher: Dispatcher) -> None:
        self.reserved: Mapping[str, Sequence[str]] = {}
        self._cell = cell
        self._dispatcher = dispatcher

    def occupied_by(self, device: str) -> frozenset[str]:
        """The zones that a device may be in the way of: it does not report the contrary, or has a command
        that leads there, or one that is over and may still be carried out.

        What moves without a command of this plant may be on its way there, and so may what has not taken its
        new work yet: it may still carry out what it was told before. What it has told may be older than its
        last stop.
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
        """Those of the zones that a device is not in the way of, and no task has reserved."""
        return held - self.occupied_by(device) - frozenset(self.reserved.get(device, ()))

    def in_the_way(self, device: str, zones: Iterable[str]) -> tuple[str, ...] | None:
        """The facts that a device at rest does not report, so that it keeps one of the zones; None where it
        is not heard, works, or keeps none of them.
        """
        belief = self._dispatcher.beliefs[device]
        wanted = self.occupied_by(device).intersection(zones)
        if not belief.online or belief.moves or self._dispatcher.ledger.of_robot(device) or not wanted:
            return None
        unsaid = [
            f"{name} {shown(value)}"
            for each in self._cell.interlocks_of(device)
            if each.zone in wanted
            for name, value in each.free_while
            if belief.fact(name) != value
        ]
        return tuple(dict.fromkeys(unsaid)) or None

    def _is_at_its_work(self, device: str) -> bool:
        """True while a device has work, and has named it as taken where it names its commands."""
        work = self._dispatcher.ledger.work_of(device)
        names_commands = self._dispatcher.model.robots[device].evidence is Evidence.IDS
        return work is not None and (work.accepted_at is not None or not names_commands)

    def led_into(self, device: str, zones: Iterable[str]) -> frozenset[str]:
        """The zones that a device is in the way of once it is out of these, as a lift between two of them."""
        locks = self._cell.interlocks_of(device)
        free = {name: value for each in locks if each.zone in zones for name, value in each.free_while}
        return frozenset(
            each.zone
            for each in locks
            if any(free.get(name, value) != value for name, value in each.free_while)
        )
