"""Parts that a task takes and lets go, and which of these steps no device has confirmed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Set

from arboleda.dispatch.belief import Belief
from arboleda.model.messages import Check
from arboleda.model.plant_model import Evidence

UNKNOWN = -1  # the boot of a board without numbers, which may have booted between two starts of the plant


class Handling:
    """Books of a task's grips. `taken` has each hand with a part, and the boot of its board at the grip."""

    def __init__(self, beliefs: Mapping[str, Belief]) -> None:
        self.taken: dict[str, int | None] = {}
        self._beliefs = beliefs
        self.unchecked: tuple[Check, ...] = ()  # in the order of the work

    def begin(self, taken: Mapping[str, int | None] | None = None, unchecked: Iterable[Check] = ()) -> None:
        """Begin a task, or go on with the books of an earlier start."""
        earlier = taken or {}
        numbered = {name for name, each in self._beliefs.items() if each.robot.evidence is Evidence.IDS}
        self.taken = {hand: boot if hand in numbered else UNKNOWN for hand, boot in earlier.items()}
        self.unchecked = _in_order(set(unchecked))

    def miss(self, check: Check) -> None:
        """Note that no device confirms this part of the work."""
        if check not in self.unchecked:
            self.unchecked = _in_order({*self.unchecked, check})

    def senses_pieces(self, robot: str) -> bool:
        """True where a robot's board reports if a piece is at its effector."""
        return self._beliefs[robot].senses_pieces

    def note(self, hand: str, *, grips: bool) -> None:
        """Book a grip or a release, which the board of `hand` has to confirm by a report.

        A board that has booted in between may have lost the part, so its release is not confirmed. Whether an
        effector that is on has gripped a part is for its piece sensor.
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
