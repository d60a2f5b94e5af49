"""The parts that a task takes hold of and lets go of, and what of that no device has confirmed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from arboleda.dispatch.belief import Belief
from arboleda.model.messages import Check
from arboleda.model.plant_model import Evidence

UNKNOWN = -1  # the boot of a board that numbers nothing, and may have booted between two starts of the plant


class Handling:
    """Books of a task's grips. `taken`: what holds a part of it, by name, with the boot of its board then."""

    def __init__(self, beliefs: Mapping[str, Belief]) -> None:
        self.taken: dict[str, int | None] = {}
        self._beliefs = beliefs
        self.unchecked: tuple[Check, ...] = ()  # what no device has confirmed, in the order of the work

    def begin(self, taken: Mapping[str, int | None] | None = None, unchecked: Iterable[Check] = ()) -> None:
        """A task begins, or goes on with what an earlier start has kept of it."""
        earlier = taken or {}
        numbered = {name for name, each in self._beliefs.items() if each.robot.evidence is Evidence.IDS}
        self.taken = {hand: boot if hand in numbered else UNKNOWN for hand, boot in earlier.items()}
        self.unchecked = _in_order(set(unchecked))

    def miss(self, check: Check) -> None:
        """Nobody can confirm this part of the work."""
        if check not in self.unchecked:
            self.unchecked = _in_order({*self.unchecked, check})

    def senses_pieces(self, robot: str) -> bool:
        """True where a robot's board reports if a piece is at its effector."""
        return self._beliefs[robot].senses_pieces

    def note(self, hand: str, *, grips: bool) -> None:
        """Book a grip, or that a part was let go, which the board of `hand` has to report. A board that has
        booted in between may have lost the part. Of an effector that is on, a piece sensor says the rest.
        """
        belief = self._beliefs[hand]
        holds = belief.held_in(belief)
        if grips:
            self.taken[hand] = belief.boot_id
            if not (holds or belief.robot.has_effector):
                self.miss(Check.GRIP)
        elif hand in self.taken and (self.taken.pop(hand) != belief.boot_id or holds is not False):
            self.miss(Check.RELEASE)


def _in_order(checks: Set[Check]) -> tuple[Check, ...]:
    return tuple(check for check in Check if check in checks)
