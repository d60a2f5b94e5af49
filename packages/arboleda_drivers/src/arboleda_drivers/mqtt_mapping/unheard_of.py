"""Checks of ends that can never be heard: values that a device never says, by its own words and numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice

from arboleda.drivers import Device, DeviceVerb, FactType, Value
from arboleda_drivers.meaning import UnreadableValue, as_text, in_words, is_number
from arboleda_drivers.plc.checks import Place, Problem

from .heard import Heard, Says, Source
from .keys import Keys

MOST = 1000  # samples of a verb's values that are looked at
CONDITIONS = ("online", "accepted", "done", "failed")


def problems(settings: Keys, device: Device) -> Iterator[Problem]:
    """Conditions that no value of a fact or state at their place meets, and facts that no value can show."""
    for place, says in _conditions(settings):
        yield from _condition(settings, device, place, says)
    for name in settings.verbs:
        if name in device.kind.verbs:
            yield from _sets(settings, device, device.kind.verbs[name])


def _conditions(settings: Keys) -> Iterator[tuple[Place, Says]]:
    for key in CONDITIONS:
        if (says := getattr(settings, key)) is not None:
            yield (key,), says
    for name, verb in settings.verbs.items():
        for key in CONDITIONS[1:]:
            if (says := getattr(verb, key)) is not None:
                yield ("verbs", name, key), says


def _condition(settings: Keys, device: Device, place: Place, says: Says) -> Iterator[Problem]:
    """Problems of values that mean nothing to whatever is heard at the same place."""
    there = [each for each in _heard(settings, device) if _place(each[1]) == _place(says)]
    for value in says.values:
        if there and not any(_means(value, heard, of) for _, heard, of in there):
            name, heard, of = there[0]
            what = f"{as_text(value)} is never heard at {says.where}"
            known = f"{name} knows {_known(heard, of)} there"
            yield (*place, "equals"), f"{what}: {known}; write one of these, or give it a word in {name}"


def _heard(settings: Keys, device: Device) -> Iterator[tuple[str, Heard, FactType | None]]:
    """The state and each fact by name, as they are heard; the state is of no type."""
    if settings.state is not None:
        yield "state", settings.state, None
    for name, heard in settings.facts.items():
        if name in device.kind.facts:
            yield name, heard, device.kind.facts[name]


def _place(source: Source) -> tuple[str, str, str]:
    return source.hear, source.path, source.pattern


def _means(value: object, heard: Heard, of: FactType | None) -> bool:
    if of is None:
        return heard.word(value) is not None
    try:
        heard.read(value, of)
    except UnreadableValue:
        return False
    return True


def _known(heard: Heard, of: FactType | None) -> str:
    """The values that are known at a place, as the device says them."""
    if not heard.words and of is not None:
        return of.allowed()
    return ", ".join(map(in_words, heard.words.values()))


def _sets(settings: Keys, device: Device, verb: DeviceVerb) -> Iterator[Problem]:
    """Problems of facts that a verb sets, and that are never heard so."""
    samples = islice(verb.samples, MOST)
    found = dict.fromkeys(pair for values in samples for pair in verb.sets_with(dict(values)))
    for name, value in found:
        heard, of = settings.facts.get(name), device.kind.facts.get(name)
        if heard is None or of is None or heard.problem(of) or _shows(heard, of, value):
            continue
        why = f"{verb.name} sets {name} to {as_text(value)}, and nothing that is heard means that"
        words = ", ".join(map(as_text, heard.words))
        yield ("facts", name), f"{why}; {f'words has {words}' if words else 'look at scale and near'}"


def _shows(heard: Heard, of: FactType, value: Value) -> bool:
    """True where the device can say this value."""
    try:
        read = heard.read(heard.shown(value), of)
    except UnreadableValue:
        return False
    if is_number(read) and is_number(value):
        return math.isclose(float(read), float(value), rel_tol=1e-6, abs_tol=1e-9)
    return read == value
