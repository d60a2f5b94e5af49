"""Grips: the state of each effector, from what was commanded and from what its board reports."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from enum import Enum

OF_EARLIER_START = "?"  # for the id of a command that nobody knows any more


class Grip(str, Enum):
    """An effector: off, on, or somewhere between the two because its switching was not confirmed."""

    OFF = "off"
    ON = "on"
    SWITCHING = "switching"


class Grips:
    """The grip of every holder; a plant that starts takes over what was kept, else off.

    `tools` are devices of their own at the end of another robot. One that is told to let go of a part opens
    until it has done so, or it is proven that it never will: it may end late what the plant has given up.
    """

    def __init__(self, holders: Collection[str], kept: Mapping[str, str], tools: Collection[str]) -> None:
        self._grips = {name: Grip(kept.get(name, Grip.OFF)) for name in holders}
        self._tools = frozenset(tools)
        kept_open = [name for name in self._tools if self._grips[name] is Grip.SWITCHING]
        self.opening = {name: {OF_EARLIER_START} for name in kept_open}  # by which commands

    def __getitem__(self, holder: str) -> Grip:
        return self._grips[holder]

    @property
    def known(self) -> dict[str, Grip]:
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
        """True where a part may hang there."""
        return self._grips[holder] is not Grip.OFF

    def open(self, holder: str, id: str) -> None:
        """This command tells it to let go of what it may hold."""
        if holder in self._tools and self.holding(holder):
            self.opening.setdefault(holder, set()).add(id)

    def will_not_open(self, holder: str, *ids: str | None) -> None:
        """It has not taken these commands, or has given them up."""
        pending = self.opening.get(holder, set())
        if not pending.isdisjoint(ids):
            pending.difference_update(ids)
            if not pending:
                del self.opening[holder]

    def forget_opening(self, holder: str) -> None:
        """It does nothing any more of what it was told before."""
        self.opening.pop(holder, None)
