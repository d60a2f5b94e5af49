"""Settings of a device behind a Siemens S7 in a plant file: its keys, checked against the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.drivers import Device, Effect, Robot
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Problem
from arboleda_drivers.plc.variables import FORMS

from .addresses import TYPES, address
from .keys import S7Keys, Variable

NAMES = {of: [name for name, (_, form, _) in TYPES.items() if form in forms] for of, forms in FORMS.items()}
NAMES[str] = ["integers with words"]
ANSWER = "say where the PLC shows its answer, answer: {at: DB1.DBW20}"


@dataclass(frozen=True, kw_only=True)
class Settings(S7Keys):
    """Settings of the driver `s7`: the connection, and the mapping of one device."""

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Device):
            yield from checks.undeclared(device)
            return
        yield from _facts(self, device)
        yield from _verbs(self, device)
        yield from _ways(self, device)


def _facts(keys: S7Keys, device: Device) -> Iterator[Problem]:
    known = device.kind.facts
    yield from checks.shown_facts(keys.facts, device, "say where the PLC shows it")
    for name, variable in keys.facts.items():
        if name in known and not variable.words:
            yield from _type(("facts", name, "at"), variable, known[name].type, known[name].allowed())


def _verbs(keys: S7Keys, device: Device) -> Iterator[Problem]:
    known = device.kind.verbs
    yield from checks.verbs(keys.verbs, device, "say what is written for it")
    for name, verb in keys.verbs.items():
        if name not in known:
            continue
        place = ("verbs", name)
        for at, write in enumerate(verb.write):
            yield from checks.argument((*place, "write", at), write, known[name], key="at", names=NAMES)
        yield from checks.shown_answer(place, verb.answer, known[name], ANSWER)
        if verb.answer is not None and known[name].effect is Effect.QUERY and not verb.answer.words:
            of = known[name].answer_type
            yield from _type((*place, "answer", "at"), verb.answer, of.type, of.allowed())
        if not verb.write:
            yield place, f"nothing is written for {name}, so the PLC cannot know what is asked"


def _type(place: checks.Place, variable: Variable, of: type, allowed: str) -> Iterator[Problem]:
    """A problem if an address without words can never show a value of that type."""
    form, at = address(variable.at).form, variable.at
    if of is str:
        yield place, f"{at} is a number, and the value is {allowed}; write words: {{WORD: 0}}"
    elif form not in (*FORMS[of], *(FORMS[int] if of is float else ())):
        yield place, f"{at} is of the type {address(at).type}, and the value is {allowed}"


def _ways(keys: S7Keys, device: Device) -> Iterator[Problem]:
    """Problems of a mapping that lacks something which the device's effects or evidence need."""
    sequence, state = keys.sequence, keys.state
    yield from checks.proof(device, "the PLC", sequence=sequence is not None)
    form, hint = "state: {at: DB1.DBW16, words: {stopped: 0, moving: 1}}", "what is written ends"
    shows = state is not None or (sequence is not None and sequence.busy is not None)
    yield from checks.ways(device, form, hint, state=shows, halt=bool(keys.halt))
    if state is not None:
        yield from checks.states(state.words)
    for key in ("halt", "latch", "clear"):
        for at, write in enumerate(getattr(keys, key)):
            yield from checks.plain((key, at), write, key)
