"""What a plant remembers of earlier starts, checked before it believes it."""

from __future__ import annotations

from arboleda.adapters.store import MOVE_AWAY, Store
from arboleda.core.dispatcher import CLEARED, LATCHED
from arboleda.core.errors import StartError
from arboleda.core.grips import Grip
from arboleda.core.messages import Fact
from arboleda.core.outside import quoted

MEANS = {  # a quarantined zone has the name of a robot, which may be none of the plant file any more
    Fact.LATCH: frozenset({LATCHED, CLEARED}),
    Fact.EFFECTOR: frozenset(grip.value for grip in Grip),
}


def remembered(store: Store) -> dict[Fact, dict[str, str]]:
    """Name to value by kind of fact; StartError where a value means nothing: it may have been a latch."""
    facts = {fact: store.facts(fact) for fact in Fact}
    for fact, allowed in MEANS.items():
        for name, value in facts[fact].items():
            if value not in allowed:
                what = f"{quoted(value)} as {fact.value} of {quoted(name)}, which means nothing"
                raise StartError(
                    f"The plant's memory {store.path} says {what}: put a copy in its place, or {MOVE_AWAY}."
                )
    return facts
