"""Campaign of a belt behind a PLC under faults: a part's way, and the failures that each may cause."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from arboleda.kinds.declared import Device
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.plc.virtual.machine import CLOSED, ENTRY, EXIT, OPEN, Belt

from .plc_loopback import Loopback, Wire
from .rig import START_S, Causes, Hear, Rig

NO_LINK = {Reason.LINK_LOST}
CAUSES: Causes = {
    "busy": {Reason.REJECTED},
    "deaf": {Reason.DEADLINE},
    "slow": {Reason.DEADLINE},
    "jam": {Reason.DEADLINE},
    "gives_up": {Reason.DEVICE_FAULT},
    "forgets": {Reason.DEADLINE},
    "lies": {Reason.NOT_REACHED, Reason.DEADLINE},
    "blind": {Reason.NOT_REACHED},
    "drive_fault": {Reason.DEVICE_FAULT},
    "reboots": {Reason.REBOOTED},
    "runs_on": {Reason.STOP_UNCONFIRMED},
    "frozen": {Reason.DEADLINE, *NO_LINK},  # too short to lose the link; the PLC has missed an order
    "nonsense": NO_LINK,
    "bad_part": {Reason.REJECTED},
}
"""The allowed reasons of a failure during, or soon after, each fault of the program."""


@dataclass(kw_only=True)
class CountedBelt(Belt):
    """Belt that counts the orders it has taken."""

    taken: int = 0

    def order(self, now: float, number: int, verb: int, to: int = 0, speed_mm_s: int = 0) -> None:
        before = self.shown.accepted
        super().order(now, number, verb, to, speed_mm_s)
        self.taken += self.shown.accepted != before


class BeltRig(Rig):
    """Test with a part that is carried to the exit; it sees the part's true place and the gate."""

    work = ((ENTRY, OPEN), (EXIT, OPEN), (EXIT, CLOSED))

    def __init__(self, example: PlantModel, faults: Mapping[str, str], causes: Causes) -> None:
        super().__init__(faults)
        self.model, self.causes = example, {**CAUSES, **causes}
        (device,) = example.robots.values()
        assert isinstance(device, Device)
        self.device, self.now = device, START_S
        self.belt = CountedBelt(faults=self.faults)
        self._given = 0

    @property
    def robots(self) -> Sequence[Robot]:
        return [self.device]

    def task(self, number: int) -> str:
        return f"line pass 200 #{number}"

    def join(self, hear: Hear, now: float) -> Loopback:
        return OrderCounter(self, self.wire(), hear, now)

    @abstractmethod
    def wire(self) -> Wire:
        """A new machine of the driver, connected to the PLC."""

    def place(self) -> tuple[int, int]:
        return (self.belt.shown.part_at, self.belt.shown.gate)

    def moves(self) -> tuple[int, int]:
        return (self.belt.taken, self._given)

    def give(self, command: Command) -> None:
        """Note a command given to the driver."""
        self._given += not isinstance(command, Stop)

    def by_hand(self) -> None:
        """Set the belt back at its panel, after a fault has stopped it."""
        self.belt.halt(self.now)


class OrderCounter(Loopback):
    """Connection that tells its rig the commands given, and the time."""

    def __init__(self, rig: BeltRig, wire: Wire, hear: Hear, now: float) -> None:
        super().__init__(rig.device.name, wire, hear, now)
        self._rig = rig

    def ask(self, command: Command) -> str | None:
        self._rig.give(command)
        return super().ask(command)

    def pass_time(self, now: float) -> None:
        self._rig.now = now
        self._rig.belt.scan(now)
        super().pass_time(now)
