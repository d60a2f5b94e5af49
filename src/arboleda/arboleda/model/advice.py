"""Advice that leads a cell out of its present state: verbs and acts of a hand, as data, in order."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum

from arboleda.model.messages import Verb
from arboleda.model.sentence import NOTHING, Phrase, Sentence
from arboleda.model.verbs import Arguments, as_text


class Hand(str, Enum):
    """Acts that only a person at a machine can do."""

    BRING_BACK = "bring_back"  # a robot that is not heard, or does not hear this plant
    REPAIR = "repair"  # a robot whose board reports a fault
    REFERENCE = "reference"  # a robot that only its own controls can home
    CHECK = "check"  # a zone, whether anybody is in it
    FREE = "free"  # a device that is in the way of a zone, and does not get out of it by a verb
    TAKE_OUT = (
        "take_out"  # the parts at a place; the scope is the cell and the place, as of the verb `unload`
    )
    PUT_IN = "put_in"  # a part that is missing at a place; the scope is the same
    LEAVE_IN = "leave_in"  # the part that is at a place in question; the scope is the same


@dataclass(frozen=True, kw_only=True)
class Advice:
    """One thing to do: a verb, or an act of a hand, on a robot, a cell or a zone.

    `instead`: it begins an alternative to the advice before it. `moves` and `drops` are the robots that it
    may set in motion, and those whose part may fall. `refusal` is why it would be refused now.
    """

    do: Verb | Hand
    scope: str
    why: Sentence
    by_hand: bool = False
    arguments: Arguments = ()
    instead: bool = False
    moves: tuple[str, ...] = ()
    drops: tuple[str, ...] = ()
    refusal: Sentence | None = None


DO: dict[Verb | Hand, Phrase] = {
    **{verb: Phrase(f"do.{verb.value}", f"{verb.value} {{scope}}") for verb in Verb},
    Hand.BRING_BACK: Phrase("do.bring_back", "bring {scope} back"),
    Hand.REPAIR: Phrase("do.repair", "repair {scope}"),
    Hand.REFERENCE: Phrase("do.reference", "home {scope} at its own controls"),
    Hand.FREE: Phrase("do.free", "get {scope} out of the way by its own controls"),
    Hand.TAKE_OUT: Phrase("do.take_out", "see that {scope} is empty and say so (unload {scope})"),
    Hand.PUT_IN: Phrase("do.put_in", "put a part at {scope} and say so (load {scope})"),
    Hand.LEAVE_IN: Phrase("do.leave_in", "say that a part is still at {scope} (load {scope})"),
    Hand.CHECK: Phrase("do.check", "see that nobody is in {scope}"),
}
BY_HAND: dict[Verb, Phrase] = {
    verb: Phrase(f"do.{verb.value}_by_hand", f"{verb.value} {{scope}} --by-hand")
    for verb in Verb
    if verb.row.by_hand
}
ADVISE = {each: Phrase(f"advise.{each.value}", act.english) for each, act in DO.items()}
ADVISE_BY_HAND = {verb: Phrase(f"advise.{verb.value}_by_hand", act.english) for verb, act in BY_HAND.items()}
"""Requests to a person: in Spanish in other words than what was done."""
THEN = Phrase("do.then", "{first}, then {second}")
OR = Phrase("do.or", "{first} or {second}")
AND = Phrase("do.and", "{first} and {second}")


def in_words(advice: Advice) -> Sentence:
    """The act, as a person types or says it."""
    return _phrase(advice, DO, BY_HAND)(scope=_told(advice))


def sentence(advices: Iterable[Advice]) -> Sentence:
    """All advice in one sentence; NOTHING without any."""
    whole = NOTHING
    for each in advices:
        joined = OR if each.instead else THEN
        asked = _phrase(each, ADVISE, ADVISE_BY_HAND)(scope=_told(each))
        whole = joined(first=whole, second=asked) if whole else asked
    return whole


def _told(advice: Advice) -> str:
    """The scope, and behind it the arguments of a verb."""
    scope = advice.scope
    return as_text(advice.do, scope, advice.arguments) if isinstance(advice.do, Verb) else scope


def _phrase(advice: Advice, acts: Mapping[Verb | Hand, Phrase], by_hand: Mapping[Verb, Phrase]) -> Phrase:
    is_by_hand = advice.by_hand and isinstance(advice.do, Verb)
    return by_hand[Verb(advice.do)] if is_by_hand else acts[advice.do]
