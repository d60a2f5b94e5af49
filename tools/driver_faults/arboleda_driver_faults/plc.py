"""Campaign of a belt behind a PLC under faults: a part's way, and the failures that each may cause."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from arboleda.drivers import Report, lost
from arboleda.kinds.declared import Device
from arboleda.model.commands import Command, Stop
from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel, Robot
from arboleda_drivers.plc.plc_snapshot import UnreadableValue
from arboleda_drivers.plc.virtual.machine import CLOSED, ENTRY, EXIT, OPEN, Belt

from .rig import START_S, Causes, Hear, Rig

POLL_S = 0.1  # twice a driver's own: enough to see every state
AGAIN_S = 0.5
BEATS = 2**16
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
        return Loopback(self, self.wire(), hear, now)

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


class LineBroken(Exception):
    """Error: nothing arrives over the line, with the reason."""


class Wire(Protocol):
    """Protocol between driver and PLC; raises LineBroken or UnreadableValue where the link would end."""

    def begin(self) -> None:
        """Connect."""

    def order(self, command: Command) -> str | None:
        """Send a command; returns the word for a refusal by the PLC, else None."""

    def beat(self, number: int) -> None:
        """Send a heartbeat."""

    def report(self, at: float) -> Report:
        """Read all mapped values, as a report."""


class Loopback:
    """Driver and virtual PLC, connected without sockets: each gets the other's values at once.

    What the drivers of PLCs do beside their machines is done here as they do it: reading again and again,
    counting up the heartbeat, ending the link where something breaks, and coming back. `hear` takes the
    reports that the plant would get of the device; the rig is told the commands given, and the time.
    """

    def __init__(self, rig: BeltRig, wire: Wire, hear: Hear, now: float) -> None:
        self._rig, self._robot, self._wire, self._hear = rig, rig.device.name, wire, hear
        self._now = self.next_deadline = now
        self._up = False
        self._beats = 0

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
        self._rig.give(command)
        if not self._up:
            return "the PLC is not connected"
        try:
            word = self._wire.order(command)
        except (LineBroken, UnreadableValue) as error:
            self._lose(error)
            return None
        if word is not None and command.id:
            self._hear(Report(at=self._now, robot=self._robot, rejected=command.id, refusal=word))
        return None

    def pass_time(self, now: float) -> None:
        """Let both do everything due by now."""
        self._now = self._rig.now = now
        self._rig.belt.scan(now)
        if now >= self.next_deadline:
            self.next_deadline = now + POLL_S
            try:
                self._poll()
            except (LineBroken, UnreadableValue) as error:
                self._lose(error)

    def _poll(self) -> None:
        if not self._up:
            self._wire.begin()
            self._up = True
        self._hear(self._wire.report(self._now))
        self._beats = (self._beats + 1) % BEATS
        self._wire.beat(self._beats)

    def _lose(self, error: Exception) -> None:
        self._up, self.next_deadline = False, self._now + AGAIN_S
        self._hear(lost(self._robot, at=self._now, why=str(error)))
