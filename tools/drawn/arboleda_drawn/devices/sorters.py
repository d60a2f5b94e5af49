"""Sorter of a drawn cell: a device that is set by its own answer, so that a recipe has an end for each.

It has dice of its own, and no other step tells it anything, so that the rest of a plant does not depend on
it.
"""

from __future__ import annotations

from dataclasses import replace

from arboleda_proofs.simulator.chance import Dice

from .kinds import Kind, Verb
from .layout import Section
from .steps import Choose, Recipe, Step, Tell, Value, Wait, Work

OFTEN = 0.2  # how often a plant has one
IN_RECIPES = 0.7  # how often a recipe asks it
KIND = ROLE = "sorter"
QUERY, SETTER, FACT = "inspect", "turn", "side"
ANSWER = "s1"
ANSWERS: tuple[tuple[Value, ...], ...] = (("good", "bad"), ("sí", "no", "quizás"), (1, 2))
SIDES: tuple[tuple[Value, ...], ...] = (("left", "right", "middle"), (0, 1, 2))


class Sorter:
    """Drawer of the sorter of a plant; `kind` is its kind, None where the plant has none."""

    def __init__(self, dice: Dice, *, are_written: bool) -> None:
        self._dice = dice
        self._answers, self._sides = dice.pick(ANSWERS), dice.pick(SIDES)
        self.kind = self._kind(is_written=are_written) if dice.chance(OFTEN) else None

    def join(self, cell: Section) -> None:
        """Put the device into a cell of the plant file."""
        if self.kind is not None:
            cell["devices"][ROLE] = {"kind": KIND}

    def after(self, recipe: Recipe) -> Recipe:
        """The recipe, now and then with the sorter at its end, which says how each answer leaves it."""
        if self.kind is None or not self._dice.chance(IN_RECIPES):
            return recipe
        sides = {answer: self._dice.pick(self._sides) for answer in self._answers}
        ways = tuple((answer, self._way(side)) for answer, side in sides.items())
        asked = Tell(role=ROLE, verb=QUERY, answer=ANSWER)
        ends = tuple(
            ((f"{ROLE}.{QUERY}", answer), (f"{ROLE}.{FACT}", side)) for answer, side in sides.items()
        )
        step = Work(steps=(recipe.step, asked, Choose(answer=ANSWER, ways=ways)))
        return replace(recipe, step=step, ends_by_answer=ends)

    def _way(self, side: Value) -> Step:
        turned = Tell(role=ROLE, verb=SETTER, values=(("to", side),))
        return Work(steps=(Wait(seconds=0.3), turned)) if self._dice.chance(0.3) else turned

    def _kind(self, *, is_written: bool) -> Kind:
        dice = self._dice
        turn = Verb(
            name=SETTER,
            effect=dice.pick(("motion", "switch")),
            parameters=(("to", self._sides),),
            sets=((FACT, "$to"),),
            takes_s=dice.pick((0.1, 0.5, 2)),
        )
        look = Verb(name=QUERY, effect="query", takes_s=dice.pick((0, 0.1, 1)), answers=self._answers)
        return Kind(name=KIND, facts=((FACT, self._sides),), verbs=(turn, look), is_written=is_written)
