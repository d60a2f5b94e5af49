"""The parts that a task takes hold of and lets go of, and what of that no device has confirmed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.dispatch.belief import Belief
from arboleda.model.messages import Check


class Handling:
    """Books of a task's grips. `taken`: what holds a part of it, by name, with the boot of its board then."""

    def __init__(self, beliefs: Mapping[str, Belief]) -> None:
        self.taken: dict[str, int | None] = {}
        self._beliefs = beliefs
        self._unchecked: set[Check] = set()

    @property
    def unchecked(self) -> tuple[Check, ...]:
        """What no device has confirmed so far, in the order of the work."""
        return tuple(check for check in Check if check in self._unchecked)

    def begin(self, taken: Mapping[str, int | None] | None = None, unchecked: Iterable[Check] = ()) -> None:
        """A task begins, or goes on with what an earlier start has kept of it."""
        self.taken, self._unchecked = dict(taken or {}), set(unchecked)

    def note(self, hand: str, *, grips: bool) -> None:
        """What holds parts has gripped, or let go: where its board has booted in between, it may have lost
        the part by that, which nobody saw.
        """
        boot = self._beliefs[hand].boot_id
        if grips:
            self.taken[hand] = boot
        elif hand in self.taken and self.taken.pop(hand) != boot:
            self._unchecked.add(Check.RELEASE)
