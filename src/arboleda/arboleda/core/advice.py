"""What leads a cell out of its present state: verbs and acts of a hand, as data, in the order to do them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from .messages import Verb


class Hand(str, Enum):
    """What only a person at a machine can do."""

    BRING_BACK = "bring_back"  # a robot that is not heard, or does not hear this plant
    REPAIR = "repair"  # a robot whose board reports a fault
    REFERENCE = "reference"  # a robot that only its own controls can home
    CHECK = "check"  # a zone: that really nobody is in it


@dataclass(frozen=True, kw_only=True)
class Advice:
    """One thing to do: a verb, or an act of a hand, on a robot, a cell or a zone, and what comes of it.

    `instead`: it begins another way out than what stands before it. `moves` and `drops`: the robots that it
    may set in motion, and those whose part falls. `refusal`: why it would be refused now.
    """

    do: Verb | Hand
    scope: str
    why: str
    by_hand: bool = False
    instead: bool = False
    moves: tuple[str, ...] = ()
    drops: tuple[str, ...] = ()
    refusal: str | None = None


SAID: dict[Hand, str] = {
    Hand.BRING_BACK: "bring {} back",
    Hand.REPAIR: "repair {}",
    Hand.REFERENCE: "home {} at its own controls",
    Hand.CHECK: "see that nobody is in {}",
}


def in_words(advice: Advice) -> str:
    """What is to be done, as a person types or says it."""
    if isinstance(advice.do, Hand):
        return SAID[advice.do].format(advice.scope)
    return f"{advice.do.value} {advice.scope}{' --by-hand' if advice.by_hand else ''}"


def sentence(ways: Sequence[Advice]) -> str:
    """All of it in one sentence; "" where there is nothing to do."""
    said = "".join(f"{' or ' if each.instead else ', then '}{in_words(each)}" for each in ways)
    return said.removeprefix(", then ").removeprefix(" or ")
