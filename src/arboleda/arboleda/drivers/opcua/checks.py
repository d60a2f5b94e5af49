"""Checks that a mapping fits the kind of its device; each problem is its keys and a sentence."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from arboleda.kinds.declared import Device, DeviceVerb, FactType
from arboleda.model.outside import among
from arboleda.model.plant_model import Robot

from ..plc import checks
from ..plc.checks import Place, Problem
from .nodes import FORMS, Argument, Variable
from .settings import Settings


def problems(settings: Settings, device: Robot) -> Iterator[Problem]:
    """All problems of the mapping of this device."""
    if not isinstance(device, Device):
        yield (), f"reaches devices of declared kinds; {device.name} is of the kind {device.kind_name}"
        return
    yield from _facts(settings, device)
    yield from _verbs(settings, device)
    yield from _ways(settings, device)


def _facts(settings: Settings, device: Device) -> Iterator[Problem]:
    known = device.kind.facts
    yield from checks.facts(settings.facts, device, "say which variable shows it")
    for name, variable in settings.facts.items():
        if name in known:
            yield from _words(("facts", name), variable.words, known[name])


def _verbs(settings: Settings, device: Device) -> Iterator[Problem]:
    known = device.kind.verbs
    yield from checks.verbs(settings.verbs, device, "say which method is called for it")
    for name, verb in settings.verbs.items():
        if name in known:
            for at, argument in enumerate(verb.given):
                yield from _given(("verbs", name, "given", at), argument, known[name])
            yield from _answers(("verbs", name), verb.answer, known[name])


def _given(place: Place, argument: Argument, verb: DeviceVerb) -> Iterator[Problem]:
    types = dict(verb.parameters)
    if argument.parameter is None:
        return
    if argument.parameter not in types:
        what = f"{verb.name} has no parameter {argument.parameter}"
        yield (*place, "value"), f"{what}; {among(argument.parameter, types)}"
        return
    of = types[argument.parameter]
    if argument.words:
        yield from _words(place, argument.words, of)
    elif argument.type not in FORMS[of.type]:
        yield (*place, "type"), f"the value is {of.allowed()}; allowed: {', '.join(FORMS[of.type])}"
    else:
        beyond = [value for value in of.samples if not argument.fits(value)]
        if beyond:
            yield place, f"{beyond[0]} is no {argument.type}; write a type that holds {of.allowed()}"


def _answers(place: Place, answer: Variable | None, verb: DeviceVerb) -> Iterator[Problem]:
    hint = "say which variable shows its answer, answer: {node: ns=2;s=Seen}"
    yield from checks.answer(place, verb, hint, mapped=answer is not None)
    if answer is not None and verb.answers:
        yield from _words((*place, "answer"), answer.words, checks.answers(verb))


def _words(place: Place, words: Mapping[str, int], of: FactType) -> Iterator[Problem]:
    missing = [str(word) for word in of.words if word not in words]
    if words and of.type is not str:
        yield place, f"has words, and is {of.allowed()}"
    elif words and missing:
        yield place, f"has no number for {', '.join(missing)}; write words: {{{missing[0]}: 0}}"
    elif words and not of.words:
        yield place, "has words, and is any text"


def _ways(settings: Settings, device: Device) -> Iterator[Problem]:
    """Problems of a mapping that lacks something which the device's effects or evidence need."""
    sequence, state = settings.sequence, settings.state
    yield from checks.proof(device, "the server", sequence=sequence is not None)
    form, hint = "state: {node: ns=2;s=Belt.State, words: {stopped: 0, moving: 1}}", "which method ends"
    yield from checks.ways(device, form, hint, state=state is not None, halt=settings.halt is not None)
    if state is not None and state.words:
        yield from checks.states(state.words)
    for key in ("halt", "latch", "clear"):
        method = getattr(settings, key)
        for at, argument in enumerate(method.given if method is not None else ()):
            if argument.parameter is not None:
                yield (key, "given", at, "value"), f"{key} has no parameters; write a value"
