"""Checks of a mapping of topics, how much may be believed by it, and examples of its messages."""

from __future__ import annotations

from collections.abc import Iterator

from arboleda.drivers import Device, DeviceVerb, Effect, Evidence, OnStop, Robot, Value, among
from arboleda_drivers.believed import examples, headline, unproven
from arboleda_drivers.meaning import as_text, in_words
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Place, Problem

from . import unheard_of
from .heard import Heard, Says
from .keys import Keys
from .sent import DEVICE, ID, MOST, NUMBER, OURS, Sent

WORKS = (Effect.MOTION, Effect.PROCESS)
NOT_CHECKED = "what becomes of it is not checked; let a sensor or a person say it"
ONLY_TELLS = "nothing is sent to it; what it tells is known"


def evidence(settings: Keys, device: Device) -> Evidence:
    """The level that the mapping gives: by ids, by facts that each verb sets, else by its state alone."""
    verbs = [verb for verb in device.kind.verbs.values() if verb.name in settings.verbs]
    if settings.unheard:
        return Evidence.STATE
    named = [verb for verb in verbs if verb.effect in WORKS or verb.effect is Effect.QUERY]
    if named and all(_names_command(settings, verb) for verb in named):
        return Evidence.IDS
    if not settings.verbs or all(verb.sets_facts or verb.effect is Effect.QUERY for verb in verbs):
        return Evidence.JOINTS
    return Evidence.STATE


def _names_command(settings: Keys, verb: DeviceVerb) -> bool:
    """True where a message about its end, or its answer, names the command."""
    if verb.effect is Effect.QUERY:
        return settings.verbs[verb.name].names_command
    done = settings.ends(verb.name)
    return done is not None and done.names_command


def problems(settings: Keys, device: Robot) -> Iterator[Problem]:
    """All problems of the mapping of this device."""
    if not isinstance(device, Device):
        yield from checks.undeclared(device)
        return
    hint = "say where it is heard, {hear: TOPIC}, or that it never is, unheard: [...]"
    yield from checks.facts([*settings.facts, *settings.unheard], device, hint)
    yield from _unheard(settings, device)
    for name, heard in settings.facts.items():
        if name in device.kind.facts and (sentence := heard.problem(device.kind.facts[name])):
            yield ("facts", name), sentence
    yield from checks.verbs(settings.verbs, device, "say what is sent, {send: [{topic: ...}]}")
    for name in settings.verbs:
        if name in device.kind.verbs:
            yield from _verb(settings, device.kind.verbs[name])
    yield from _ways(settings, device)
    yield from unheard_of.problems(settings, device)
    yield from unproven(device, evidence(settings, device))


def _unheard(settings: Keys, device: Device) -> Iterator[Problem]:
    """Problems of facts that are never told: nothing else may hear them, and no work may set them."""
    for at, name in enumerate(settings.unheard):
        if name in settings.facts:
            yield ("unheard", at), f"{name} is heard by facts; keep one of them"
    for verb in device.kind.verbs.values():
        silent = [name for name, _ in verb.sets if name in settings.unheard]
        if silent and verb.effect in WORKS:
            why = f"{verb.name} is a {verb.effect.value}, and nothing would say that it has ended"
            yield ("unheard",), f"{why}; only a switch may set {silent[0]}"


def _verb(settings: Keys, verb: DeviceVerb) -> Iterator[Problem]:
    mapped, place = settings.verbs[verb.name], ("verbs", verb.name)
    if not mapped.send:
        yield place, f"nothing is sent for {verb.name}; write send: [{{topic: ..., payload: ...}}]"
    for at, sent in enumerate(mapped.send):
        yield from _sent((*place, "send", at), sent, [name for name, _ in verb.parameters])
        if sent.retain and verb.effect in WORKS:
            why = f"a device that connects later would begin to {verb.name} by itself"
            yield (*place, "send", at, "retain"), f"a retained order stays at the broker: {why}"
    hint = "say where its answer is heard, answer: {hear: TOPIC}, and where it names the command, id: PATH"
    yield from checks.answer(place, verb, hint, mapped=mapped.answer is not None)
    if mapped.answer is not None and (sentence := mapped.answer.problem(verb.answer_type)):
        yield (*place, "answer"), sentence
    if mapped.answer is not None and verb.effect is Effect.QUERY and not mapped.names_command:
        why = "its answer has to name the command: say where, id: PATH"
        yield place, f"{why}; where it names none, let a recipe read a fact instead"
    yield from _ids(settings, verb)


def _sent(place: Place, sent: Sent, parameters: list[str]) -> Iterator[Problem]:
    for name in sorted(sent.names - {*parameters, *OURS}):
        known = [*parameters, *OURS]
        yield place, f"there is no parameter {name}; {among(name, known)}"


def _ids(settings: Keys, verb: DeviceVerb) -> Iterator[Problem]:
    """A problem where an answer has to name a command that was sent without its id."""
    mapped, failed = settings.verbs[verb.name], settings.fails(verb.name)
    named = any({ID, NUMBER} & sent.names for sent in mapped.send)
    is_named = _names_command(settings, verb) or (failed is not None and failed.names_command)
    told = (settings.accepts(verb.name), settings.ends(verb.name), failed, mapped.answer)
    if any(each is not None and each.is_reply for each in told):
        if not any(sent.reply for sent in mapped.send):
            yield ("verbs", verb.name, "send"), "its answer is heard on {reply}; send it with reply: true"
    elif is_named and not named:
        how = f"send it with {{id}}, a text, or {{number}}, a whole number from 1 to {MOST}"
        yield ("verbs", verb.name, "send"), f"its end names the command; {how}"


def _ways(settings: Keys, device: Device) -> Iterator[Problem]:
    """Problems of a device that moves: its state must be heard, and something must be sent to stop it."""
    for key in ("ask", "halt", "latch", "clear"):
        for at, sent in enumerate(getattr(settings, key)):
            for name in sorted(sent.names - {DEVICE}):
                yield (key, at), f"{key} has no parameters, and names {name}; write values"
    if settings.state is not None:
        yield from checks.states(settings.state.words)
    for name in settings.still.facts if settings.still is not None else ():
        if name not in settings.facts:
            yield ("still", "facts"), f"there is no fact {name}; {among(name, settings.facts)}"
    works = [verb for verb in device.kind.verbs.values() if verb.effect in WORKS]
    if works and settings.state is None and settings.still is None and not _ends(settings, works):
        how = "say where its state is heard, state: {hear: TOPIC, words: {stopped: idle, moving: busy}}"
        yield (), f"nothing says whether it has ended {works[0].name}: {how}, or still: {{facts: [...]}}"
    if device.kind.verbs and device.has_stop and not settings.halt:
        how = "say what is sent to stop it, halt: [{topic: ...}], or stop: none of the device"
        yield ("halt",), f"no stop would reach {device.name}: {how}"


def _ends(settings: Keys, works: list[DeviceVerb]) -> bool:
    """True where a message ends each of these verbs, and no stop has to be seen."""
    return all(
        verb.name in settings.verbs and settings.ends(verb.name) is not None and verb.on_stop is OnStop.FINISH
        for verb in works
    )


def shown(settings: Keys, device: Device) -> Iterator[str]:
    """Lines for a person: what is sent for each verb, and what is believed."""
    believed = NOT_CHECKED if settings.unheard else "" if settings.verbs else ONLY_TELLS
    yield headline(device.name, evidence(settings, device), believed)
    ours: dict[str, Value] = {DEVICE: settings.name_of(device.name), ID: f"{device.name}-1", NUMBER: 1}
    for name, mapped in settings.verbs.items():
        for given, values in examples(device.kind.verbs[name]):
            for sent in mapped.send:
                message = sent.filled({**dict(values), **ours})
                yield f"  {given}: {message.topic} {message.payload.decode()}".rstrip()
    for name, heard in settings.facts.items():
        yield f"  {name}: {heard.named(settings.name_of(device.name))} {_what(heard)}".rstrip()
    name = settings.name_of(device.name)
    for key in ("online", "accepted", "done", "failed"):
        if (says := getattr(settings, key)) is not None:
            yield f"  {key}: {says.named(name)} {_condition(says)}".rstrip()
    if settings.state is not None:
        yield f"  state: {settings.state.named(name)} {_what(settings.state)}".rstrip()
    for key in ("halt", "latch", "clear"):
        for sent in getattr(settings, key):
            message = sent.filled(ours)
            yield f"  {key}: {message.topic} {message.payload.decode()}".rstrip()
    if settings.verbs and not settings.halt:
        yield f"  stop reaches nothing of {device.name}"


def _condition(says: Says) -> str:
    meant = " or ".join(map(as_text, says.values))
    named = f"with the command in {says.id}" if says.id else ""
    return " ".join(each for each in (says.path or says.pattern, meant, named) if each)


def _what(heard: Heard) -> str:
    words = ", ".join(f"{in_words(meant)} is {word}" for word, meant in heard.words.items())
    return " ".join(each for each in (heard.path or heard.pattern, heard.unit, words) if each)
