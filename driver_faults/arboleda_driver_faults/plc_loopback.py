"""A driver's machine and the virtual PLC, joined without sockets, under a clock that is moved by hand.

What the drivers of PLCs do beside their machines is done here as they do it: reading again and again,
counting up the heartbeat, ending the link where something breaks, and coming back.
"""

from __future__ import annotations

from typing import Protocol

from arboleda.drivers import Report, lost
from arboleda.drivers.plc.plc_snapshot import UnreadableValue
from arboleda.model.commands import Command

from .trial import Hear

POLL_S = 0.1  # twice a driver's own: enough to see every state
AGAIN_S = 0.5
BEATS = 2**16


class LineBroken(Exception):
    """Nothing can be heard on the line, and why."""


class Wire(Protocol):
    """One protocol between a machine and the PLC; Broken or Unreadable where the link would be lost."""

    def begin(self) -> None:
        """Connect."""

    def order(self, command: Command) -> str | None:
        """Say a command; the word of the refusal, where the PLC refuses to take it."""

    def beat(self, number: int) -> None:
        """Say that somebody is there."""

    def report(self, at: float) -> Report:
        """Read all that is mapped."""


class Loopback:
    """What one says the other hears at once; `hear` gets what the plant would hear of the device."""

    def __init__(self, robot: str, wire: Wire, hear: Hear, now: float) -> None:
        self._robot, self._wire, self._hear = robot, wire, hear
        self._now = self.next_deadline = now
        self._up = False
        self._beats = 0

    def ask(self, command: Command) -> str | None:
        """Command the device; why it could not leave, or None."""
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
        """Have both do what is due by now."""
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
