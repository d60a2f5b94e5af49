"""Driver and virtual PLC, connected without sockets, under a clock that is moved by hand.

What the drivers of PLCs do beside their machines is done here as they do it: reading again and again,
counting up the heartbeat, ending the link where something breaks, and coming back.
"""

from __future__ import annotations

from typing import Protocol

from arboleda.drivers import Report, lost
from arboleda.model.commands import Command
from arboleda_drivers.plc.plc_snapshot import UnreadableValue

from .rig import Hear

POLL_S = 0.1  # twice a driver's own: enough to see every state
AGAIN_S = 0.5
BEATS = 2**16


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
    """Driver and virtual PLC, connected: each gets the other's values at once.

    `hear` takes the reports that the plant would get of the device.
    """

    def __init__(self, robot: str, wire: Wire, hear: Hear, now: float) -> None:
        self._robot, self._wire, self._hear = robot, wire, hear
        self._now = self.next_deadline = now
        self._up = False
        self._beats = 0

    def ask(self, command: Command) -> str | None:
        """Command the device; returns the reason why the command could not leave, or None."""
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
        self._now = now
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
