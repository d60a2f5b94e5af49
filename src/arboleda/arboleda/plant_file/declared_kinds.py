"""Kinds of devices that a plant file declares: their facts, and verbs with what they set and need."""

from __future__ import annotations

import inspect
import keyword
from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

from arboleda.kinds import rules
from arboleda.kinds.declared import DeviceKind, DeviceVerb, Effect, FactType, Slot
from arboleda.kinds.rules import OF_OTHER, SLOT
from arboleda.model.facts import Facts, Value
from arboleda.model.messages import BUILT_IN
from arboleda.recipes.handles import DeviceHandle
from arboleda.wire import mqtt_limits

from .document import Document, Place, choice, nearest, shown
from .shapes import MAPPING, NAME_RULE, KindShape, VerbShape, is_name
from .shipped_kinds import RESERVED

T = TypeVar("T")
Types = Mapping[str, "FactType | None"]
SECTION: Place = ("kinds",)
NUMBERS = {"int": rules.INT, "number": rules.NUMBER}
PLAIN = {**NUMBERS, "text": rules.TEXT, "bool": rules.BOOL}
WITH_LIMITS = "; a number with limits is of a kind in Python: Number(1, 60)"
OF_STEPS = tuple(
    name for name, _ in inspect.getmembers(DeviceHandle, inspect.isfunction) if not name.startswith("_")
)
OF_FACTS = ("self", "at_most_s", *sorted(BUILT_IN))  # parameters of these steps beside facts; facts of robots


def kinds(document: Document) -> dict[str, DeviceKind]:
    """Every correct kind of the file by name; problems of the other kinds are kept."""
    if not document.has(SECTION):
        return {}
    document.read_plain(MAPPING, SECTION)
    declared = {name: _kind(document, name) for name in document.keys(SECTION)}
    return {name: kind for name, kind in declared.items() if kind is not None}


def verbs_of(device: Any) -> Mapping[str, DeviceVerb]:
    """The verbs of a device by name; empty for a robot whose kind has no verbs."""
    return device.kind.verbs if device.verb_names else {}


def _kind(document: Document, name: str) -> DeviceKind | None:
    place: Place = (*SECTION, name)
    named = _is_named(document, place, "a kind", RESERVED)
    shape = document.read(KindShape, place)
    facts = _types(document, (*place, "facts"), "a fact", OF_FACTS)
    verbs = {
        verb: _verb(document, (*place, "verbs", verb), facts) for verb in document.keys((*place, "verbs"))
    }
    types, whole = _right(facts), _right(verbs)
    if shape is None or types is None or whole is None:
        return None
    if not facts and not verbs:
        document.problem(place, "a kind needs verbs, or facts, or both", at=place)
        return None
    if not _is_free_of(document, place, rules.release_objection(whole)):
        return None
    kind = DeviceKind(name=name, facts=types, verbs=whole)
    return kind if named and _fits(document, place, kind) else None


def _fits(document: Document, place: Place, kind: DeviceKind) -> bool:
    """True if the messages on MQTT can carry all commands and reports of a kind."""
    objections = mqtt_limits.objections(kind)
    for each in objections:
        document.problem((*place, *each.place), each.sentence)
    return not objections


def _verb(document: Document, place: Place, facts: Types) -> DeviceVerb | None:
    named = _is_named(document, place, "a verb", OF_STEPS)
    shape = document.read(VerbShape, place)
    slots = _types(document, (*place, "with"), "a parameter", ("self",))
    sets = _facts(document, (*place, "sets"), facts, slots)
    is_free = document.has((*place, "needs")) and document.value((*place, "needs")) == {}
    needs = () if is_free else _facts(document, (*place, "needs"), facts, None)
    others = _needs_of_others(document, (*place, "needs"))
    answers = _answers(document, place, shape.effect) if shape else None
    parameters = _right(slots)
    if shape is None or parameters is None or sets is None or needs is None:
        return None
    verb = DeviceVerb(
        name=str(place[-1]),
        effect=shape.effect,
        parameters=tuple(parameters.items()),
        sets=sets,
        needs=tuple((fact, value) for fact, value in needs if not isinstance(value, Slot)),
        needs_of_others=others,
        says_needs=document.has((*place, "needs")),
        takes_s=shape.takes_s,
        at_most_s=shape.at_most_s or rules.patience_s(shape.takes_s),
        on_stop=shape.on_stop,
        works_on_part=document.has((*place, "works_on")),
        makes_part=document.has((*place, "makes")),
        holds=document.has((*place, "holds")),
        answers=answers[0] if answers else (),
        number=answers[1] if answers else None,
    )
    fits = [check(document, place, verb) for check in CHECKS]
    return verb if named and answers is not None and all(fits) else None


def _check_time(document: Document, place: Place, verb: DeviceVerb) -> bool:
    return _is_free_of(document, (*place, "at_most_s"), rules.time_objection(verb))


def _is_free_of(document: Document, place: Place, objection: str | None) -> bool:
    """True if there is no objection; an objection is kept as a problem."""
    if objection is not None:
        document.problem(place, objection)
    return objection is None


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


def _check_makes(document: Document, place: Place, verb: DeviceVerb) -> bool:
    wrong = verb.makes_part and verb.effect is not Effect.PROCESS
    if wrong:
        document.problem((*place, "makes"), f"only a process makes a part, and this is a {verb.effect.value}")
    return not wrong


def _check_query(document: Document, place: Place, verb: DeviceVerb) -> bool:
    wrong = verb.effect is Effect.QUERY and bool(verb.sets)
    if wrong:
        document.problem((*place, "sets"), "a query sets nothing; it has answers")
    return not wrong


def _check_holds(document: Document, place: Place, verb: DeviceVerb) -> bool:
    return _is_free_of(document, (*place, "holds"), rules.holding_objection(verb))


CHECKS = (_check_time, _check_stop, _check_makes, _check_holds, _check_query)


def _answers(
    document: Document, place: Place, effect: Effect
) -> tuple[tuple[Value, ...], FactType | None] | None:
    """The answers that are listed, and the type of an answer that is a number; None if they are wrong."""
    here = (*place, "answers")
    if effect is not Effect.QUERY:
        if document.has(here):
            document.problem(here, f"only a query has answers, and this is a {effect.value}")
            return None
        return (), None
    if not document.has(here):
        document.problem(place, 'a query needs "answers", a list of what it may answer, e.g. [good, bad]')
        return None
    given = document.value(here)
    if isinstance(given, list):
        type = _listed(document, here)
        return None if type is None else (type.words, None)
    if given in ("int", "number"):
        return (), NUMBERS[given]
    document.problem(
        here, f"must be a list of words or numbers, or int or number for any number; is {shown(given)}"
    )
    return None


def _types(document: Document, place: Place, what: str, taken: Sequence[str]) -> Types:
    """The types in a mapping by name; None for a wrong one, with the problem kept."""
    if not document.has(place):
        return {}
    document.read_plain(MAPPING, place)
    names = document.keys(place)
    named = {name: _is_named(document, (*place, name), what, taken) for name in names}
    types = {name: _type(document, (*place, name)) for name in names}
    return {name: type if named[name] else None for name, type in types.items()}


def _right(rows: Mapping[str, T | None]) -> dict[str, T] | None:
    """The rows if none of them is wrong, else None."""
    right = {name: value for name, value in rows.items() if value is not None}
    return right if len(right) == len(rows) else None


def _type(document: Document, place: Place) -> FactType | None:
    value = document.value(place)
    if isinstance(value, list):
        return _listed(document, place)
    if not isinstance(value, str) or value not in PLAIN:
        hint = nearest(value, PLAIN) if isinstance(value, str) else WITH_LIMITS * isinstance(value, dict)
        allowed = choice([*PLAIN, "a list of words or numbers"])
        document.problem(place, f"must be {allowed}, is {shown(value)}{hint}")
        return None
    return PLAIN[value]


def _listed(document: Document, place: Place) -> FactType | None:
    """The type of a value that is one of some words, or of some numbers."""
    try:
        return rules.listed(document.value(place), shown)
    except rules.ListError as error:
        document.problem(place if error.index is None else (*place, error.index), str(error))
        return None


def _facts(
    document: Document, place: Place, facts: Types, slots: Types | None
) -> tuple[tuple[str, Value | Slot], ...] | None:
    """The facts with their values, None if one is wrong; `slots` are the parameters that a value may name."""
    if not document.has(place):
        return ()
    mapping = document.read_plain(MAPPING, place)
    values: dict[str, Value | Slot | None] = {}
    for name in document.keys(place):
        if slots is None and OF_OTHER in name:
            continue
        here, type, value = (*place, name), facts.get(name), document.value((*place, name))
        if name not in facts:
            there = f"facts: {', '.join(facts)}" if facts else "this kind has none"
            document.problem(place, f"there is no fact {shown(name)}{nearest(name, facts)}; {there}", at=here)
        if type is None:
            values[name] = None  # the problem is reported at the fact
        elif slots is not None and isinstance(value, str) and value.startswith(SLOT):
            values[name] = _slot(document, here, type, slots)
        else:
            values[name] = _value(document, here, type)
    right: dict[str, Value | Slot] | None = _right(values)
    return None if mapping is None or right is None else tuple(right.items())


def _needs_of_others(document: Document, place: Place) -> Facts:
    """The needs that name a role and a fact of its device, as "reader.lid"; each cell checks them."""
    return tuple((name, document.value((*place, name))) for name in document.keys(place) if OF_OTHER in name)


def _slot(document: Document, place: Place, fact: FactType, slots: Types) -> Slot | None:
    name = str(document.value(place)).removeprefix(SLOT)
    if name not in slots:
        there = f'"with" has {", ".join(slots)}' if slots else 'the verb has no "with"'
        document.problem(place, f"there is no parameter {shown(name)}{nearest(name, slots)}; {there}")
        return None
    type = slots[name]
    if type is None:
        return None
    fits = _is_free_of(document, place, rules.slot_objection(name, type, str(place[-1]), fact))
    return Slot(name=name) if fits else None


def _value(document: Document, place: Place, type: FactType) -> Value | None:
    value = document.value(place)
    read = type.read(value)
    if read is not None:
        return read
    hint = nearest(value, map(str, type.words)) if isinstance(value, str) else ""
    slot = f"; {SLOT} stands for a parameter in sets only" if str(value).startswith(SLOT) else ""
    document.problem(place, f"must be {type.allowed()}, is {shown(value)}{hint}{slot}")
    return None


def _is_named(document: Document, place: Place, what: str, taken: Sequence[str]) -> bool:
    """True if the last key of `place` can be a name in a recipe, such as each in `mill.run(program=1)`."""
    objection = name_objection(str(place[-1]), what, taken)
    if objection is not None:
        document.problem(place, objection, at=place)
    return objection is None


def name_objection(name: str, what: str, taken: Sequence[str]) -> str | None:
    """The reason for which something cannot have that name."""
    if not is_name(name):
        return f"the name of {what} must be {NAME_RULE}"
    if not keyword.iskeyword(name) and name not in taken:
        return None
    why = "is a word of Python" if keyword.iskeyword(name) else "is taken"
    return f"the name {shown(name)} {why}; give {what} another one"
