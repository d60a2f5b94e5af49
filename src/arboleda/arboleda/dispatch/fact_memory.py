"""Facts that outlive the plant: stops, grips, occupied zones, places with parts, steps of tasks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.model.commands import Command
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Notice, Remember

Memory = Mapping[Fact, Mapping[str, str]]
LATCHED, CLEARED = "on", "cleared"  # a stop: until it is cleared, then until its cell is reset
DISPLACED = EMPTIED = "true"
FACT_VALUES = {
    Fact.LATCH: frozenset({LATCHED, CLEARED}),
    Fact.EFFECTOR: frozenset(grip.value for grip in Grip),
    Fact.DISPLACED: frozenset({DISPLACED}),
    Fact.EMPTIED: frozenset({EMPTIED}),
}
"""The values that a fact may have. A quarantined zone has the name of a robot, which may be none of the plant
file any more."""


class FactMemory:
    """Memory of a plant. A change goes to the outbox, so that it is kept before later messages leave."""

    def __init__(self, facts: Memory, outbox: list[Command | Notice]) -> None:
        self._facts: dict[tuple[Fact, str], str | None] = {
            (fact, name): value for fact, values in facts.items() for name, value in values.items()
        }
        self._outbox = outbox

    def remember(self, fact: Fact, name: str, value: str | None) -> None:
        """Have a fact kept, unless it has that value already; None removes it."""
        if self._facts.get((fact, name)) != value:
            self._facts[fact, name] = value
            self._outbox.append(Remember(fact=fact, name=name, value=value))

    def value(self, fact: Fact, name: str) -> str | None:
        """The value of a fact; None where it has none."""
        return self._facts.get((fact, name))

    def names(self, fact: Fact) -> set[str]:
        """The names under which a fact has a value."""
        return {name for (kind, name), value in self._facts.items() if kind is fact and value is not None}

    def occupy(self, zones: Iterable[str], robot: str) -> None:
        """Remember that a robot may be in these zones."""
        for zone in sorted(zones):
            self.remember(Fact.QUARANTINE, zone, robot)

    def vacate(self, zones: Iterable[str]) -> None:
        """Remember that nobody is in these zones any more."""
        for zone in sorted(zones):
            self.remember(Fact.QUARANTINE, zone, None)
