"""Rules for every kind of device, however it is written: its types, and verbs that fit each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from unicodedata import normalize

from arboleda.model.facts import Value
from arboleda.model.outside import quoted

from .declared import DeviceVerb, Effect, FactType, Slot

BOOL = FactType(type=bool, first=False)
INT = FactType(type=int, first=0)
NUMBER = FactType(type=float, first=0.0)
TEXT = FactType(type=str, first="")
PATIENCE, LEAST_S = 3.0, 2.0  # a verb may take so many times `takes_s`, and never less than this
LONGEST_WORD = 64
SLOT = "$"
OF_OTHER = "."  # between a role and a fact of its device, in what a verb needs


class ListError(Exception):
    """Error: a list cannot be a type; `index` is that of the wrong value, None for the list itself."""

    def __init__(self, sentence: str, index: int | None = None) -> None:
        super().__init__(sentence)
        self.index = index


def listed(values: Sequence[object], shown: Callable[[object], str] = quoted) -> FactType:
    """The type of a list of words or of numbers, the first of which a virtual device begins with.

    Raises ListError for any other list.
    """
    values = [normalize("NFC", value) if isinstance(value, str) else value for value in values]
    types = {type(value) for value in values}
    if types == {int, float}:
        values, types = [float(value) for value in values], {float}  # type: ignore[arg-type]
    wrong = next((index for index, value in enumerate(values) if not _is_word(value)), None)
    twice = next((index for index, value in enumerate(values) if value in values[:index]), None)
    if not values:
        raise ListError("must have at least 1 value, has 0")
    if types == {bool}:
        raise ListError("for true and false, write bool")
    if len(types) > 1:
        raise ListError("must be all words or all numbers; a word that looks like a number needs quotes")
    if wrong is not None:
        rule = f"must be a number, or a word of 1 to {LONGEST_WORD} letters without {SLOT} before it"
        raise ListError(f"{rule}; is {shown(values[wrong])}", wrong)
    if twice is not None:
        raise ListError(f"{shown(values[twice])} is there twice", twice)
    words: tuple[Value, ...] = tuple(values)  # type: ignore[arg-type]
    return FactType(type=type(words[0]), words=words, first=words[0])


def patience_s(takes_s: float) -> float:
    """The time limit, s, of a verb for which only its usual duration is given."""
    return max(LEAST_S, PATIENCE * takes_s)


def slot_objection(name: str, given: FactType, fact: str, type: FactType) -> str | None:
    """The reason why a parameter cannot stand for a fact; None if it can."""
    if type.covers(given):
        return None
    return f"{name} may be {given.allowed()}, and {fact} is {type.allowed()}"


def time_objection(verb: DeviceVerb) -> str | None:
    """The reason why a verb has too little time to end; None if it has enough."""
    if verb.at_most_s >= verb.takes_s:
        return None
    return f"must be at least takes_s, which is {verb.takes_s:g}; is {verb.at_most_s:g}"


def holding_objection(verb: DeviceVerb) -> str | None:
    """The reason why a verb cannot hold a part, which takes exactly one bool fact; None if it can."""
    if not verb.holds:
        return None
    if verb.effect is not Effect.SWITCH:
        return f"only a switch holds a part, and this is a {verb.effect.value}"
    types = dict(verb.parameters)
    values = [types[value.name].first if isinstance(value, Slot) else value for _, value in verb.sets]
    if sum(isinstance(value, bool) for value in values) != 1:
        rule = "must set exactly one fact that is a bool: whether it holds a part"
        return f"a verb that holds a part {rule}"
    return None


def release_objection(verbs: Mapping[str, DeviceVerb]) -> str | None:
    """The reason why verbs hold more than one part, or cannot let it go; None if all is well."""
    holding = [verb for verb in verbs.values() if verb.holds]
    facts = list(dict.fromkeys(verb.held[0] for verb in holding))
    if len(facts) > 1:
        return f"a device holds one part; these facts say so: {', '.join(facts)}"
    if holding and not any(verb.lets_go() for verb in holding):
        return f"nothing lets go of the part: no verb with holds: part sets {facts[0]} to false"
    return None


def _is_word(value: object) -> bool:
    if isinstance(value, str):
        return 0 < len(value) <= LONGEST_WORD and value.isprintable() and not value.startswith(SLOT)
    return isinstance(value, int | float) and abs(value) < float("inf")
