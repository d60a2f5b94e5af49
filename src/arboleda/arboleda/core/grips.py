"""What each effector may hold: what was commanded, and what the board reports where it does."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum


class Grip(str, Enum):
    """An effector: off, on, or somewhere between the two because its switching was not confirmed."""

    OFF = "off"
    ON = "on"
    SWITCHING = "switching"


class Grips:
    """The grip of every arm; a plant that starts takes over what was kept, else off."""

    def __init__(self, arms: list[str], kept: Mapping[str, str]) -> None:
        self._grips = {arm: Grip(kept.get(arm, Grip.OFF)) for arm in arms}

    def __getitem__(self, arm: str) -> Grip:
        return self._grips[arm]

    def set(self, arm: str, grip: Grip) -> bool:
        """Whether that was new."""
        changed = self._grips[arm] is not grip
        self._grips[arm] = grip
        return changed

    def holding(self, arm: str) -> bool:
        """Whether a part may hang there."""
        return self._grips[arm] is not Grip.OFF
