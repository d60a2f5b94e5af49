"""Grips: the state of each effector, by commands and by reports."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from enum import Enum

OF_EARLIER_START = "?"  # stands for the id of a command of an earlier start


class Grip(str, Enum):
    """Grip of an effector: off, on, or between the two until its switching is confirmed."""

    OFF = "off"
    ON = "on"
    SWITCHING = "switching"


class Grips:
    """The grip of every holder; `earlier` has the grips of an earlier start, else a holder is off.

    `tools` are devices of their own at the end of a robot. A tool that was told to let go counts as `opening`
    until it has done so, or surely never will: it may still do late what the plant has given up.
    """

    def __init__(self, holders: Collection[str], earlier: Mapping[str, str], tools: Collection[str]) -> None:
        self._grips = {name: Grip(earlier.get(name, Grip.OFF)) for name in holders}
        self._tools = frozenset(tools)
        kept_open = [name for name in self._tools if self._grips[name] is Grip.SWITCHING]
        self.opening = {name: {OF_EARLIER_START} for name in kept_open}  # by which commands

    def __getitem__(self, holder: str) -> Grip:
        return self._grips[holder]

    @property
    def by_holder(self) -> dict[str, Grip]:
        """The grip of every holder now."""
        return dict(self._grips)

    def set(self, holder: str, grip: Grip) -> bool:
        """Set the grip of a holder; True where that is new."""
        changed = self._grips[holder] is not grip
        self._grips[holder] = grip
        if grip is not Grip.SWITCHING:
            self.opening.pop(holder, None)
        return changed

    def holding(self, holder: str) -> bool:
        """True where a holder may hold a part."""
        return self._grips[holder] is not Grip.OFF

    def open(self, holder: str, id: str) -> None:
        """Note a command that tells a holder to let go."""
        if holder in self._tools and self.holding(holder):
            self.opening.setdefault(holder, set()).add(id)

    def will_not_open(self, holder: str, *ids: str | None) -> None:
        """Drop commands that a holder has not taken, or has given up."""
        pending = self.opening.get(holder, set())
        if not pending.isdisjoint(ids):
            pending.difference_update(ids)
            if not pending:
                del self.opening[holder]

    def forget_opening(self, holder: str) -> None:
        """Drop all commands to a holder: it carries out none of them any more."""
        self.opening.pop(holder, None)
