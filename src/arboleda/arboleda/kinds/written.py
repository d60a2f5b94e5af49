"""Conversion of kinds written in Python to those of the engine; raises KindError if that is impossible."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import islice, product

from arboleda.model.facts import Value
from arboleda.model.outside import among, quoted

from . import rules
from .declared import DeviceKind, DeviceVerb, Effect, FactType, Slot, UseError, VerbCall
from .rules import SLOT
from .verbs import KindError, Number, Verb

DAY_S = 86400.0
TRIED = 200  # combinations of the parameters of a verb that are tried
PLAIN: Mapping[object, FactType] = {
    bool: rules.BOOL,
    int: rules.INT,
    float: rules.NUMBER,
    str: rules.TEXT,
}
ALLOWED = "bool, int, float, str, Number(lower, upper) or a list of words or numbers"
FORMS = "motion(...), process(...), switch(...) or query(...)"


def types_of(place: str, given: Mapping[str, object]) -> dict[str, FactType]:
    """The types of facts or parameters, by name."""
    return {_name(place, name): type_of(f"{place}.{name}", each) for name, each in given.items()}


def _name(place: str, name: str) -> str:
    if not isinstance(name, str):
        raise KindError(f"{place} has names, and {quoted(name)} is none")
    return name


def verb_of(name: str, verb: Verb, facts: Mapping[str, FactType]) -> DeviceVerb:
    """The engine's form of a verb."""
    _name("verbs", name)
    if not isinstance(verb, Verb):
        raise KindError(f"{name} is {quoted(verb)}; a verb is {FORMS}")
    slots = types_of(f"{name}.parameters", verb.parameters)
    if callable(verb.sets) and verb.holds_part:
        raise KindError(f"{name}: what a verb that holds a part sets is written down, not computed")
    takes_s = 0.0 if callable(verb.takes_s) else _seconds(f"{name}.takes_s", verb.takes_s, at_least=0.0)
    if callable(verb.takes_s) and verb.at_most_s is None:
        raise KindError(f"{name}: takes_s is computed, so it needs at_most_s, how long it is waited for")
    at_most_s = rules.patience_s(takes_s) if verb.at_most_s is None else verb.at_most_s
    needs = verb.needs or {}
    answers = _answers(f"{name}.answers", verb.answers) if verb.effect is Effect.QUERY else None
    made = DeviceVerb(
        name=name,
        effect=verb.effect,
        parameters=tuple(slots.items()),
        sets=() if callable(verb.sets) else tuple(_sets(name, verb.sets, facts, slots)),
        needs=tuple(_needs(name, needs, facts)),
        needs_of_others=tuple(each for each in needs.items() if rules.OF_OTHER in each[0]),
        says_needs=verb.needs is not None,
        takes_s=takes_s,
        at_most_s=_seconds(f"{name}.at_most_s", at_most_s, at_least=1e-3),
        on_stop=verb.on_stop,
        works_on_part=verb.works_on_part,
        makes_part=verb.makes_part,
        holds=verb.holds_part,
        answers=() if answers is None else answers.words,
        number=None if answers is None or answers.words else answers,
        sets_by=verb.sets if callable(verb.sets) else None,
        takes_s_by=verb.takes_s if callable(verb.takes_s) else None,
        virtual=verb.virtual,
    )
    refuse(name, rules.holding_objection(made))
    return made


def _sets(
    verb: str, sets: Mapping[str, Value], facts: Mapping[str, FactType], slots: Mapping[str, FactType]
) -> Iterator[tuple[str, Value | Slot]]:
    for name, value in sets.items():
        type = _fact(f"{verb}.sets", name, facts)
        if not isinstance(value, str) or not value.startswith(SLOT):
            yield name, _value(f"{verb}.sets.{name}", type, value)
            continue
        slot = value.removeprefix(SLOT)
        if slot not in slots:
            raise KindError(f"{verb}.sets.{name}: no parameter {quoted(slot)}; {among(slot, slots)}")
        refuse(f"{verb}.sets.{name}", rules.slot_objection(slot, slots[slot], name, type))
        yield name, Slot(name=slot)


def _needs(
    verb: str, needs: Mapping[str, Value], facts: Mapping[str, FactType]
) -> Iterator[tuple[str, Value]]:
    for name, value in needs.items():
        if rules.OF_OTHER in name:
            continue
        yield name, _value(f"{verb}.needs.{name}", _fact(f"{verb}.needs", name, facts), value)


def _fact(place: str, name: str, facts: Mapping[str, FactType]) -> FactType:
    if name not in facts:
        raise KindError(f"{place}: no fact {quoted(name)}; {among(name, facts)}")
    return facts[name]


def _value(place: str, type: FactType, value: object) -> Value:
    read = type.read(value)
    if read is None:
        raise KindError(f"{place} must be {type.allowed()}, is {quoted(value)}")
    return read


def type_of(place: str, given: object) -> FactType:
    if isinstance(given, Number):
        return given.type
    if isinstance(given, list | tuple):
        return _listed(place, given)
    if not isinstance(given, type) or given not in PLAIN:
        raise KindError(f"{place} must be {ALLOWED}, is {quoted(given)}")
    return PLAIN[given]


def _listed(place: str, values: object) -> FactType:
    if not isinstance(values, list | tuple):
        raise KindError(f"{place} must be a list of words or numbers, is {quoted(values)}")
    try:
        return rules.listed(values)
    except rules.ListError as error:
        raise KindError(f"{place} {error}") from None


def _answers(place: str, given: object) -> FactType:
    if isinstance(given, Number) or given in (int, float):
        return type_of(place, given)
    return _listed(place, given)


def _seconds(place: str, value: object, *, at_least: float) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    if not is_number or not at_least <= value <= DAY_S:  # type: ignore[operator]
        raise KindError(f"{place} must be {at_least:g} to {DAY_S:g} s, is {quoted(value)}")
    return float(value)  # type: ignore[arg-type]


def timed(made: DeviceKind) -> DeviceKind:
    """The kind with its verbs tried with values of their parameters, and with the longest time of each."""
    verbs = {name: replace(verb, takes_s=_longest_s(made, verb)) for name, verb in made.verbs.items()}
    for name, verb in verbs.items():
        refuse(f"{name}.at_most_s", rules.time_objection(verb))
    return replace(made, verbs=verbs)


def _longest_s(made: DeviceKind, verb: DeviceVerb) -> float:
    first = {name: type.first for name, type in made.facts.items()}
    longest = verb.takes_s
    for values in _combinations(verb):
        try:
            call = made.command(id="", robot="", verb=verb.name, values=values)
            assert isinstance(call, VerbCall)
            longest = max(longest, call.takes_s)
            if verb.effect is Effect.QUERY:
                made.answer_of(call, tuple(first.items()))
            else:
                made.shown_by(call, tuple((first | dict(call.sets)).items()))
        except UseError as error:
            with_them = ", ".join(f"{name}={value!r}" for name, value in values.items())
            raise KindError(f"{error}, with {with_them}" if with_them else str(error)) from error.__cause__
    return longest


def _combinations(verb: DeviceVerb) -> Iterator[dict[str, Value]]:
    names = [name for name, _ in verb.parameters]
    for values in islice(product(*(type.samples for _, type in verb.parameters)), TRIED):
        yield dict(zip(names, values, strict=True))


def refuse(place: str, objection: str | None) -> None:
    if objection is not None:
        raise KindError(f"{place}: {objection}")
