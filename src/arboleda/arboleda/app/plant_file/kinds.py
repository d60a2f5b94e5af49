"""Kinds of devices that a plant file declares: their facts, and verbs with what they set and need."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Mapping, Sequence
from typing import TypeVar

from arboleda.core.facts import Value
from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, FactType, Slot
from arboleda.recipes.handles import DeviceHandle

from .document import Document, Place, choice, nearest, shown
from .shapes import MAPPING, NAME_RULE, KindShape, VerbShape, is_name

T = TypeVar("T")
Types = Mapping[str, "FactType | None"]
SECTION: Place = ("kinds",)
PLAIN = {
    "int": FactType(type=int, first=0),
    "number": FactType(type=float, first=0.0),
    "text": FactType(type=str, first=""),
    "bool": FactType(type=bool, first=False),
}
RESERVED = ("arm", "mobile", "person")
OF_STEPS = tuple(
    name for name, _ in inspect.getmembers(DeviceHandle, inspect.isfunction) if not name.startswith("_")
)
OF_FACTS = ("self", "at_most_s")  # what those steps have beside facts
PATIENCE, LEAST_S = 3.0, 2.0  # a verb may take so many times `takes_s`, and never less than this
LONGEST_WORD = 64
SLOT = "$"


def kinds(document: Document) -> dict[str, DeviceKind]:
    """Every kind of the file that is right, by name; the problems of the others are kept."""
    if not document.has(SECTION):
        return {}
    document.read_plain(MAPPING, SECTION)
    found = {name: _kind(document, name) for name in document.keys(SECTION)}
    return {name: kind for name, kind in found.items() if kind is not None}


def _kind(document: Document, name: str) -> DeviceKind | None:
    place: Place = (*SECTION, name)
    named = _is_named(document, place, "a kind", RESERVED)
    shape = document.read(KindShape, place)
    facts = _types(document, (*place, "facts"), "a fact", OF_FACTS)
    verbs = {
        verb: _verb(document, (*place, "verbs", verb), facts) for verb in document.keys((*place, "verbs"))
    }
    types, whole = _right(facts), _right(verbs)
    if shape is None or types is None or whole is None or not _lets_go(document, place, whole):
        return None
    return DeviceKind(name=name, facts=types, verbs=whole) if named else None


def _verb(document: Document, place: Place, facts: Types) -> DeviceVerb | None:
    named = _is_named(document, place, "a verb", OF_STEPS)
    shape = document.read(VerbShape, place)
    slots = _types(document, (*place, "with"), "a parameter", ("self",))
    sets = _facts(document, (*place, "sets"), facts, slots)
    needs = _facts(document, (*place, "needs"), facts, None)
    answers = _answers(document, place, shape.effect) if shape else None
    parameters = _right(slots)
    if shape is None or parameters is None or sets is None or needs is None:
        return None
    at_most_s = shape.at_most_s or max(LEAST_S, PATIENCE * shape.takes_s)
    verb = DeviceVerb(
        name=str(place[-1]),
        effect=shape.effect,
        parameters=tuple(parameters.items()),
        sets=sets,
        needs=tuple((fact, value) for fact, value in needs if not isinstance(value, Slot)),
        takes_s=shape.takes_s,
        at_most_s=at_most_s,
        on_stop=shape.on_stop,
        holds=document.has((*place, "holds")),
        answers=answers or (),
    )
    fits = [check(document, place, verb) for check in (_check_time, _check_stop, _check_holds, _check_query)]
    return verb if named and answers is not None and all(fits) else None


def _check_time(document: Document, place: Place, verb: DeviceVerb) -> bool:
    if verb.at_most_s < verb.takes_s:
        rule = f"must be at least takes_s, which is {verb.takes_s:g}"
        document.problem((*place, "at_most_s"), f"{rule}; is {verb.at_most_s:g}")
    return verb.at_most_s >= verb.takes_s


def _check_stop(document: Document, place: Place, verb: DeviceVerb) -> bool:
    wrong = document.has((*place, "on_stop")) and verb.effect is not Effect.PROCESS
    if wrong:
        what = (
            "a motion is always halted"
            if verb.effect is Effect.MOTION
            else f"a {verb.effect.value} is not halted"
        )
        document.problem((*place, "on_stop"), f"only a process has it; {what}")
    return not wrong


def _check_query(document: Document, place: Place, verb: DeviceVerb) -> bool:
    wrong = verb.effect is Effect.QUERY and bool(verb.sets)
    if wrong:
        document.problem((*place, "sets"), "a query sets nothing; it has answers")
    return not wrong


def _check_holds(document: Document, place: Place, verb: DeviceVerb) -> bool:
    """Whether a verb that holds a part says so by one fact, a yes or no."""
    here = (*place, "holds")
    if not verb.holds:
        return True
    types = dict(verb.parameters)
    values = [types[value.name].first if isinstance(value, Slot) else value for _, value in verb.sets]
    if verb.effect is not Effect.SWITCH:
        document.problem(here, f"only a switch holds a part, and this is a {verb.effect.value}")
    elif len(values) != 1 or not isinstance(values[0], bool):
        told = "must set exactly one fact, and that a bool: whether it holds a part"
        document.problem(here, f"a verb that holds a part {told}")
    elif len(types) > sum(isinstance(value, Slot) for _, value in verb.sets):
        document.problem(here, "a verb that holds a part has no parameter but the one that it sets")
    else:
        return True
    return False


def _lets_go(document: Document, place: Place, verbs: Mapping[str, DeviceVerb]) -> bool:
    """Whether what verbs hold is one part, and can be let go."""
    holding = {name: verb.sets[0] for name, verb in verbs.items() if verb.holds}
    facts = list(dict.fromkeys(fact for fact, _ in holding.values()))
    if len(facts) > 1:
        document.problem(place, f"a device holds one part; these facts say so: {', '.join(facts)}")
    elif holding and all(value is True for _, value in holding.values()):
        what = f"nothing lets go of the part: no verb with holds: part sets {facts[0]} to false"
        document.problem(place, what)
    else:
        return True
    return False


def _answers(document: Document, place: Place, effect: Effect) -> tuple[Value, ...] | None:
    here = (*place, "answers")
    if effect is not Effect.QUERY:
        if document.has(here):
            document.problem(here, f"only a query has answers, and this is a {effect.value}")
            return None
        return ()
    if not document.has(here):
        document.problem(place, 'a query needs "answers", a list of what it may answer, e.g. [good, bad]')
        return None
    type = _listed(document, here) if isinstance(document.value(here), list) else None
    if type is None and not isinstance(document.value(here), list):
        document.problem(here, f"must be a list of words or numbers, is {shown(document.value(here))}")
    return None if type is None else type.words


def _types(document: Document, place: Place, what: str, taken: Sequence[str]) -> Types:
    """The types in a mapping by name; None for one that is wrong, with the problem kept."""
    if not document.has(place):
        return {}
    document.read_plain(MAPPING, place)
    names = document.keys(place)
    named = {name: _is_named(document, (*place, name), what, taken) for name in names}
    types = {name: _type(document, (*place, name)) for name in names}
    return {name: type if named[name] else None for name, type in types.items()}


def _right(rows: Mapping[str, T | None]) -> dict[str, T] | None:
    """The rows, where none of them is wrong."""
    right = {name: value for name, value in rows.items() if value is not None}
    return right if len(right) == len(rows) else None


def _type(document: Document, place: Place) -> FactType | None:
    value = document.value(place)
    if isinstance(value, list):
        return _listed(document, place)
    if not isinstance(value, str) or value not in PLAIN:
        hint = nearest(value, PLAIN) if isinstance(value, str) else ""
        allowed = choice([*PLAIN, "a list of words or numbers"])
        document.problem(place, f"must be {allowed}, is {shown(value)}{hint}")
        return None
    return PLAIN[value]


def _listed(document: Document, place: Place) -> FactType | None:
    """One of some words, or of some numbers; the first is what a virtual device begins with."""
    values = document.value(place)
    types = {type(value) for value in values}
    if types == {int, float}:
        values, types = [float(value) for value in values], {float}
    wrong = next((index for index, value in enumerate(values) if not _is_word(value)), None)
    if not values:
        document.problem(place, "must have at least 1 value, has 0")
    elif types == {bool}:
        document.problem(place, "for true and false, write bool")
    elif len(types) > 1:
        document.problem(
            place, "must be all words or all numbers; a word that looks like a number needs quotes"
        )
    elif wrong is not None:
        rule = f"must be a number, or a word of 1 to {LONGEST_WORD} letters without {SLOT} before it"
        document.problem((*place, wrong), f"{rule}; is {shown(values[wrong])}")
    elif len(set(values)) < len(values):
        twice = next(index for index, value in enumerate(values) if value in values[:index])
        document.problem((*place, twice), f"{shown(values[twice])} is there twice")
    else:
        return FactType(type=types.pop(), words=tuple(values), first=values[0])
    return None


def _is_word(value: object) -> bool:
    if isinstance(value, str):
        return 0 < len(value) <= LONGEST_WORD and value.isprintable() and not value.startswith(SLOT)
    return isinstance(value, int | float) and abs(value) < float("inf")


def _facts(
    document: Document, place: Place, facts: Types, slots: Types | None
) -> tuple[tuple[str, Value | Slot], ...] | None:
    """Facts with their values; `slots` are what a value may stand for, None where it may for none."""
    if not document.has(place):
        return ()
    mapping = document.read_plain(MAPPING, place)
    values: dict[str, Value | Slot | None] = {}
    for name in document.keys(place):
        here, type, value = (*place, name), facts.get(name), document.value((*place, name))
        if name not in facts:
            there = f"facts: {', '.join(facts)}" if facts else "this kind has none"
            document.problem(place, f"there is no fact {shown(name)}{nearest(name, facts)}; {there}", at=here)
        if type is None:
            values[name] = None  # what is wrong with it is told there
        elif slots is not None and isinstance(value, str) and value.startswith(SLOT):
            values[name] = _slot(document, here, type, slots)
        else:
            values[name] = _value(document, here, type)
    right = _right(values)
    return None if mapping is None or right is None else tuple(right.items())


def _slot(document: Document, place: Place, fact: FactType, slots: Types) -> Slot | None:
    name = str(document.value(place)).removeprefix(SLOT)
    if name not in slots:
        there = f'"with" has {", ".join(slots)}' if slots else 'the verb has no "with"'
        document.problem(place, f"there is no parameter {shown(name)}{nearest(name, slots)}; {there}")
        return None
    given = slots[name]
    if given is None:
        return None
    beyond = bool(fact.words) and not given.words
    if beyond or not all(fact.takes(value) for value in given.words or (given.first,)):
        document.problem(place, f"{name} may be {given.allowed()}, and {place[-1]} is {fact.allowed()}")
        return None
    return Slot(name=name)


def _value(document: Document, place: Place, type: FactType) -> Value | None:
    value = document.value(place)
    if type.takes(value):
        return type.type(value)
    hint = nearest(value, map(str, type.words)) if isinstance(value, str) else ""
    slot = f"; {SLOT} stands for a parameter in sets only" if str(value).startswith(SLOT) else ""
    document.problem(place, f"must be {type.allowed()}, is {shown(value)}{hint}{slot}")
    return None


def _is_named(document: Document, place: Place, what: str, taken: Sequence[str]) -> bool:
    """Whether the last key of `place` can be a name in a recipe, as `mill.run(program=1)` has three."""
    name = str(place[-1])
    good = is_name(name) and not keyword.iskeyword(name) and name not in taken
    if not is_name(name):
        document.problem(place, f"the name of {what} must be {NAME_RULE}", at=place)
    elif not good:
        why = "is a word of Python" if keyword.iskeyword(name) else "is taken"
        document.problem(place, f"the name {shown(name)} {why}; give {what} another one", at=place)
    return good
