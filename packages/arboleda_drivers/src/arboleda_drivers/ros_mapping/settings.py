"""Settings of the driver `ros` in a plant file, and what in them does not fit the device or ROS 2."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import islice

from arboleda.drivers import Device, DeviceVerb, DriverError, Effect, Evidence, OnStop, Robot, Value, among
from arboleda_drivers.believed import examples, headline, unproven
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Place, Problem

from .heard_facts import STATE
from .keys import Call, Keys, Source, Verb
from .types import HEARD, heard_in, message_of, misspelt

WORKS = (Effect.MOTION, Effect.PROCESS)
SAMPLES = 64  # of a verb's values


@dataclass(frozen=True, kw_only=True)
class Settings(Keys):
    """Settings of the driver `ros`: the mapping of one device."""

    def evidence_of(self, device: Robot) -> Evidence:
        """The evidence of the mapping: actions and services name their calls; messages name nothing."""
        return Evidence.JOINTS if any(_published_works(self, device)) else Evidence.IDS

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Device):
            yield from checks.undeclared(device)
            return
        yield from unproven(device, self.evidence_of(device))
        yield from checks.facts(self.facts, device, "say where it is heard, {topic: ..., field: ...}")
        yield from checks.verbs(self.verbs, device, "say what is sent for it, {action: ..., type: ...}")
        for place, source in self.sources:
            yield from _source(self, device, place, source)
        if self.state is not None:
            yield from checks.states(list(self.state.words))
        for name, verb in self.verbs.items():
            if name in device.kind.verbs:
                yield from _verb(("verbs", name), verb, device.kind.verbs[name])
        yield from _published(self, device)
        yield from _stops(self, device)

    def shown(self, device: Robot) -> Iterator[str]:
        """Lines for a person: what is sent, and what is believed."""
        if not isinstance(device, Device):
            return
        yield headline(device.name, self.evidence_of(device))
        for name, verb in self.verbs.items():
            for given, values in examples(device.kind.verbs[name]):
                yield f"  {given}: {_shown(self, verb, dict(values))}"
        for name, source in self.facts.items():
            if source.topic:
                yield f"  {name}: {self.full(source.topic)} {source.field}"
        if self.halt is not None:
            yield f"  halt: {_shown(self, self.halt, {})}"
        elif not any(verb.action for verb in self.verbs.values()):
            yield f"  stop reaches nothing of {device.name}"


def _shown(keys: Keys, call: Call, values: dict[str, Value]) -> str:
    fields = ", ".join(f"{path}: {value}" for path, value in call.filled(values).items())
    return f"{call.kind} {keys.full(call.name)} {{{fields}}}"


def _published_works(keys: Keys, device: Robot) -> Iterator[DeviceVerb]:
    """The works for which only a message is published: nothing says that it was taken."""
    if isinstance(device, Device):
        for name, verb in device.kind.verbs.items():
            if verb.effect in WORKS and name in keys.verbs and keys.verbs[name].publish:
                yield verb


def _source(keys: Keys, device: Device, place: Place, source: Source) -> Iterator[Problem]:
    of = device.kind.facts.get(str(place[-1])) if len(place) > 1 else STATE
    if of is not None and (sentence := source.problem(of)):
        yield place, sentence
    if source.topic:
        yield from _typed(place, source.type, [("", source.field)])
    elif len(place) == 1:
        yield place, "state is heard from a topic: {topic: ..., type: ..., field: ..., words: {moving: 1}}"
    elif not source.done:
        yield from _of_verb(keys, place, source)


def _of_verb(keys: Keys, place: Place, source: Source) -> Iterator[Problem]:
    """Problems of a fact that is feedback or result of a verb."""
    key, name = "feedback" if source.feedback else "result", keys.verb_of(source)
    if not name:
        yield place, f"say of which verb this is the {key}, verb: NAME; {among('', keys.verbs)}"
    elif name not in keys.verbs:
        yield (*place, "verb"), f"there is no verb {name}; {among(name, keys.verbs)}"
    elif keys.verbs[name].kind not in (("action",) if source.feedback else tuple(HEARD)):
        yield place, f"{name} is no action, and has no {key}"
    else:
        verb = keys.verbs[name]
        part = "Feedback" if source.feedback else HEARD[verb.kind]
        yield from _typed((*place, key), verb.type, [(part, source.path)])


def _verb(place: Place, verb: Verb, known: DeviceVerb) -> Iterator[Problem]:
    parameters = [name for name, _ in known.parameters]
    strange = [(path, name) for path, name in verb.parameters if name not in parameters]
    for path, name in strange:
        yield (*place, "fields", path), f"{known.name} has no parameter {name}; {among(name, parameters)}"
    hint = "say which field of the result answers it, answer: {field: ...}"
    yield from checks.answer(place, known, hint, mapped=verb.answer is not None)
    if verb.answer and known.effect is Effect.QUERY and (why := verb.answer.problem(known.answer_type)):
        yield (*place, "answer"), why
    if verb.publish and (verb.done or verb.failure or verb.answer):
        yield place, "what is published has no result, so done, failure and answer say nothing"
    if verb.publish and known.effect in WORKS and verb.qos.durability == "transient_local":
        yield (*place, "qos"), f"whoever starts later would do {known.name} again; write durability: volatile"
    if not strange:
        yield from _call(place, verb, known)


def _call(place: Place, call: Call, known: DeviceVerb | None = None) -> Iterator[Problem]:
    """Problems of the values that are sent, and of the types where ROS 2 is there."""
    told = [*call.done, *(each.field for each in (call.failure, getattr(call, "answer", None)) if each)]
    wrong = list(_typed(place, call.type, [(HEARD.get(call.kind, ""), path) for path in told]))
    yield from wrong
    try:
        for values in islice(known.samples, SAMPLES) if known is not None else [()]:
            fields = call.filled(dict(values))
            if not wrong and find_spec("rclpy") and find_spec(call.type.split("/")[0]):
                message_of(call, fields)
    except DriverError as error:
        yield place, str(error)
    except KeyError as error:
        yield place, f"this has no parameters; write a value in place of ${error.args[0]}"


def _typed(place: Place, type: str, paths: list[tuple[str, str]]) -> Iterator[Problem]:
    """Problems of a type, and of paths in parts of it, where ROS 2 and the type's package are there."""
    if find_spec("rclpy") is None:
        return
    if sentence := misspelt(type):
        yield (*place, "type"), sentence
    elif find_spec(type.split("/")[0]):
        for part, path in paths:
            try:
                heard_in(type, part, path)
            except DriverError as error:
                yield place, str(error)


def _published(keys: Keys, device: Device) -> Iterator[Problem]:
    """Problems of works that are published: facts have to prove them, and no question can be answered."""
    works = list(_published_works(keys, device))
    for verb in works:
        heard = [name in keys.facts and bool(keys.facts[name].topic) for name, _ in verb.sets]
        if not heard or not all(heard):
            how = "let it set some, make it an action or a service, or say effect: switch"
            yield ("verbs", verb.name), f"{verb.name} is published, so only facts of topics prove it: {how}"
        elif verb.effect is Effect.PROCESS and keys.state is None:
            why = f"{verb.name} is a process that is published, and has to be seen at work: map state"
            yield ("verbs", verb.name), why
    for name, mapped in keys.verbs.items():
        is_query = name in device.kind.verbs and device.kind.verbs[name].effect is Effect.QUERY
        if is_query and (works or mapped.publish):
            who = name if mapped.publish else works[0].name
            why = f"{who} is published, so nothing answers the query {name} by its name; make it a service"
            yield ("verbs", who), why


def _stops(keys: Keys, device: Device) -> Iterator[Problem]:
    for place, call in keys.calls:
        if place[0] != "verbs":
            yield from _call(place, call)
    if keys.halt is not None or not device.has_stop:
        return
    for name, verb in device.kind.verbs.items():
        halts = verb.effect in WORKS and verb.on_stop is OnStop.HALT
        if name in keys.verbs and halts and not keys.verbs[name].action:
            how = "say what does it, halt: {service: /stop, type: std_srvs/srv/Trigger}"
            why = f"{name} could not be stopped, as only an action has a cancel: {how}"
            yield ("halt",), f"{why}; or let it end, on_stop: finish of the verb, or stop: none of the device"
            return
