"""Waits for parts and for room at places, beside the moves of a drawn recipe.

They have dice of their own, so that the rest of a recipe does not depend on them.
"""

from __future__ import annotations

from arboleda_proofs.simulator.chance import Dice

from .layout import Layout, Parts
from .steps import Gets, Invert, Parallel, Param, Step, Work

OFTEN = 0.5  # how often a move has waits beside it
SOON_S = 0.3  # within which nothing comes that is in vain
IN_TIME_S = 3600.0  # within which another branch has brought or taken the part


class AskedPlaces:
    """Drawer of waits beside moves; of a nest only where no other cell has the machine that it is in."""

    def __init__(self, dice: Dice, layout: Layout, parts: Parts) -> None:
        self._dice = dice
        self._parts = parts
        self._is_ours = not parts.machine or not layout.device(parts.machine).is_shared

    def from_source(self, source: str | Param, moved: list[Step]) -> list[Step]:
        """A move of a part from where people fill to where they empty, or to the nest."""
        if not moved or not self._dice.chance(OFTEN):
            return moved
        goal = Gets(place=self._parts.goal, what="room", at_most_s=IN_TIME_S)
        return [Gets(place=source, what="part", at_most_s=IN_TIME_S), goal, *moved]

    def to_nest(self, moved: list[Step]) -> list[Step]:
        """A move of a part to the nest, which is empty until then."""
        return self._beside("part", moved)

    def from_nest(self, moved: list[Step]) -> list[Step]:
        """A move of the part in the nest to the goal; there is no room for another one until then."""
        return self._beside("room", moved)

    def _beside(self, what: str, moved: list[Step]) -> list[Step]:
        """The move by which a nest gets something: a wait beside it, or before it one in vain."""
        dice, nest = self._dice, self._parts.nest
        if not self._is_ours or not dice.chance(OFTEN):
            return moved
        gets = Gets(place=nest, what=what, at_most_s=IN_TIME_S)
        if dice.chance(0.5):
            return [Parallel(branches=(gets, Work(steps=tuple(moved))))]
        in_vain = Invert(step=Gets(place=nest, what=what, at_most_s=SOON_S))
        return [in_vain, *moved, gets]
