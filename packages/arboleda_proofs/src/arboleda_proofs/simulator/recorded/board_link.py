"""Link to one board, followed by the messages that reached the bridge and not by the bridge's own account."""

from __future__ import annotations

import math
from typing import Any

from arboleda.drivers import Evidence, Robot
from arboleda.engine import Belief


class KnownLink:
    """Link to a board: up from telemetry on, until the broker, the board's presence or its silence end it.

    `is_open`: telemetry can come, as the broker is reached and the board does not say that it is gone.
    `silent_at`: when its silence has lasted too long, while there is a link to lose. `is_boot`: the last
    telemetry was the first of another boot. `least` is the oldest epoch that the board obeys, `least_before`
    after the step before. Of this step: `fell`, `rose`; `was_down` after the step before, or as a new bridge
    reports it.
    """

    def __init__(self, robot: Robot, stale_after_s: float) -> None:
        self.patience_s = math.inf if robot.evidence is Evidence.STATE else stale_after_s
        self.up = self.is_open = self.fell = self.rose = self.is_boot = False
        self.was_down = True
        self.telemetry_at = -math.inf
        self.silent_at = math.inf
        self.number: int | None = None
        self.least = self.least_before = -1
        self._boot: int | None = None
        self._connected = False

    def take_over(self, now: float, belief: Belief) -> None:
        """Begin with what the plant believes."""
        self.connect(True)
        self._boot = belief.boot_id
        self.up, self.telemetry_at = belief.heard_at is not None, now
        self.silent_at = now + self.patience_s if self.up else math.inf
        self.was_down = not self.up

    def connect(self, up: bool) -> None:
        """Take the state of the broker, which says anew later which boards are gone."""
        self._connected = self.is_open = up

    def presence(self, payload: bytes) -> None:
        """Take what stands for the presence of the board; one that is gone is to be lost."""
        if payload in (b"0", b"1"):
            is_there = payload == b"1"
            self.is_open = self._connected and is_there
            self.rose |= self.up and is_there

    def lose(self) -> None:
        self.fell |= self.up
        self.up, self.silent_at = False, math.inf

    def hear(self, at: float, fields: dict[str, Any], *, in_hindsight: bool = False) -> bool:
        """Take telemetry; False if it does not count, as its number does not rise above that of its boot."""
        number, boot = fields.get("seq"), fields.get("arranque")
        is_counted = boot is not None and boot == self._boot and not in_hindsight
        if is_counted and number is not None and self.number is not None and number <= self.number:
            return False
        self.is_boot = boot is not None and self._boot is not None and boot != self._boot
        self.rose |= not self.up or self.is_boot
        self.up, self.telemetry_at, self.number = True, at, number
        self.silent_at = at + self.patience_s
        self._boot = fields.get("arranque", self._boot)
        self.least = max(fields.get("epoca_ack", -1), fields.get("epoca_min", -1))
        return True
