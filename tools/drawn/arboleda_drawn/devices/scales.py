"""Scale of a drawn cell: a device that answers a number and tells one, by which recipes go on.

It has dice of its own, and no other step tells it anything, so that the rest of a plant does not depend on
it.
"""

from __future__ import annotations

from collections.abc import Mapping

from arboleda_proofs.simulator.chance import Dice

from .kinds import Kind, Span, Type, Verb
from .layout import Section
from .steps import Becomes, Choose, Fail, Invert, Range, Says, Step, Tell, Wait, Work

OFTEN = 0.2  # how often a plant has one
IN_RECIPES = 0.7  # how often a recipe asks it
KIND = ROLE = "scale"
QUERY, SETTER, FACT = "gauge", "warm", "celsius"
ANSWER = "n1"
SOON_S = 5.0
BETWEEN: Mapping[Type, tuple[float, ...]] = {  # numbers that divide those of a type, none at its limits
    "number": (-2.5, 0.0, 0.5, 20, 80.1),
    "int": (-3, 0, 7, 100),
    Span(lower=0, upper=9): (2, 5, 7),
    Span(lower=-40, upper=125): (-10, 0, 60),
    Span(lower=0.5, upper=2.0): (0.75, 1.0, 1.5),
}


class Scale:
    """Drawer of the scale of a plant; `kind` is its kind, None where the plant has none."""

    def __init__(self, dice: Dice, *, are_written: bool) -> None:
        self._dice = dice
        types = [each for each in BETWEEN if are_written or isinstance(each, str)]
        self._answered, self._told = dice.pick(types), dice.pick(types)
        self.kind = self._kind(is_written=are_written) if dice.chance(OFTEN) else None

    def join(self, cell: Section) -> None:
        """Put the device into a cell of the plant file."""
        if self.kind is not None:
            cell["devices"][ROLE] = {"kind": KIND}

    def draw(self) -> list[Step]:
        """A way by the number that the scale answers, a comparison of the one that it tells, or both."""
        if self.kind is None or not self._dice.chance(IN_RECIPES):
            return []
        compared = self._compared() if self._dice.chance(0.6) else []
        return [*self._chosen(), *compared] if self._dice.chance(0.8) or not compared else compared

    def _chosen(self) -> list[Step]:
        ways = tuple((each, self._way(number)) for number, each in enumerate(self._ranges()))
        return [Tell(role=ROLE, verb=QUERY, answer=ANSWER), Choose(answer=ANSWER, ways=ways)]

    def _ranges(self) -> list[Range]:
        """Ranges of which each number has one; that of all others, where it is, comes last."""
        dice = self._dice
        low, high = self._two()
        below, above = ("<", ">=") if dice.chance(0.5) else ("<=", ">")
        under, over = ("<", ">=") if dice.chance(0.5) else ("<=", ">")
        found = [
            Range(comparisons=((below, low),)),
            Range(comparisons=((above, low), (under, high))),
            Range(comparisons=((over, high),)),
        ]
        if dice.chance(0.7):
            found.remove(dice.pick(found))
            found.append(Range(comparisons=()))
        return found

    def _two(self) -> tuple[float, float]:
        numbers = BETWEEN[self._answered]
        first = self._dice.below(len(numbers) - 1)
        return numbers[first], self._dice.pick(numbers[first + 1 :])

    def _way(self, number: int) -> Step:
        dice = self._dice
        if number and dice.chance(0.1):
            return Fail(sentence="it is too heavy")
        if dice.chance(0.5):
            return self._warm(dice.pick(BETWEEN[self._told]))
        return Wait(seconds=0.3) if dice.chance(0.5) else Work()

    def _compared(self) -> list[Step]:
        """A number that the scale is to tell, then a comparison that is met, one that is not, or both."""
        dice = self._dice
        number = dice.pick(BETWEEN[self._told])
        is_met = Range(comparisons=((dice.pick((">=", "<=")), number),))
        is_not = Range(comparisons=((dice.pick((">", "<")), number),))
        met: Step = Says(role=ROLE, fact=FACT, value=is_met)
        if dice.chance(0.5):
            met = Becomes(role=ROLE, fact=FACT, value=is_met, at_most_s=SOON_S)
        unmet = Invert(step=Says(role=ROLE, fact=FACT, value=is_not))
        return [self._warm(number), *dice.pick(((met,), (unmet,), (met, unmet), (unmet, met)))]

    def _warm(self, number: float) -> Tell:
        return Tell(role=ROLE, verb=SETTER, values=(("to", number),))

    def _kind(self, *, is_written: bool) -> Kind:
        dice = self._dice
        takes_s = dice.pick((0, 0.1, 1))
        warm = Verb(
            name=SETTER,
            effect=dice.pick(("process", "switch", "motion")),
            parameters=(("to", self._told),),
            sets=((FACT, "$to"),),
            takes_s=dice.pick((0.1, 0.5, 2)),
        )
        gauge = Verb(name=QUERY, effect="query", takes_s=takes_s, numbers=self._answered)
        return Kind(name=KIND, facts=((FACT, self._told),), verbs=(warm, gauge), is_written=is_written)
