"""Ends of a drawn recipe that says how it leaves a device that cells share.

They have dice of their own, so that the rest of a recipe does not depend on them.
"""

from __future__ import annotations

from arboleda_proofs.simulator.chance import Dice

from .kinds import another_value, value_of
from .layout import Layout, Need
from .state import Planner, State
from .steps import Step, Tell, Using, Value, Wait, Work

OFTEN = 0.5  # how often a recipe says so
LONGEST_S = 6.0  # that its verbs take together
LINGERS_S = (3.0, 10.0, 20.0)  # before it is done, while another cell may have the device

Ends = tuple[tuple[str, Value], ...]


class SharedEnds:
    """Drawer of such ends: a recipe begins with another value of a fact, and is done later than its own."""

    def __init__(self, dice: Dice, layout: Layout) -> None:
        self._dice = dice
        self._layout = layout
        self._planner = Planner(layout, dice)
        shared = [each for each in layout.devices if each.is_shared and not each.tool_of]
        self._facts = [(each, fact) for each in shared for fact in each.kind.is_settable]

    def around(self, steps: list[Step], using: frozenset[str]) -> tuple[list[Step], Ends]:
        """The steps of a recipe with such an end, and what it says; `using`: the roles that it holds where it
        tells one of them.
        """
        dice = self._dice
        if not self._facts or not dice.chance(OFTEN):
            return steps, ()
        device, fact = dice.pick(self._facts)
        value = value_of(dice, device.kind.type_of(fact))
        other = another_value(dice, device.kind.type_of(fact), value)
        first, last = (self._tells((device.role, fact, each), using) for each in (other, value))
        if first is None or last is None:
            return steps, ()
        lingers = Wait(seconds=dice.pick(LINGERS_S))
        return [first, *steps, last, lingers], ((f"{device.role}.{fact}", value),)

    def _tells(self, need: Need, using: frozenset[str]) -> Step | None:
        """The verbs that make a fact so; None where that cannot be, or takes long."""
        made = self._planner.establish(State(), [need])
        if made is None or sum(self._takes_s(each) for each in made[0]) > LONGEST_S:
            return None
        tells = Work(steps=tuple(made[0]))
        return Using(roles=tuple(sorted(using)), step=tells) if using else tells

    def _takes_s(self, tell: Tell) -> float:
        return self._layout.device(tell.role).kind.verb(tell.verb).takes_s
