"""Settings of a device behind OPC UA in a plant file: its keys, checked against the device."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from arboleda.drivers import Device, Robot
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Place, Problem

from .keys import OpcUaKeys
from .nodes import Argument, Order

ANSWER = "say which variable shows its answer, answer: {node: ns=2;s=Seen}"


@dataclass(frozen=True, kw_only=True)
class Settings(OpcUaKeys):
    """Settings of the driver `opcua`: the connection, and the mapping of one device.

    Passwords are in the environment, under the prefix `secrets`.
    """

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Device):
            yield from checks.undeclared(device)
            return
        yield from checks.shown_facts(self.facts, device, "say which variable shows it")
        yield from _verbs(self, device)
        yield from _ways(self, device)


def _verbs(keys: OpcUaKeys, device: Device) -> Iterator[Problem]:
    known = device.kind.verbs
    yield from checks.verbs(keys.verbs, device, "say which method is called for it, or what is written")
    for name, verb in keys.verbs.items():
        if name in known:
            for place, argument in _arguments(verb):
                yield from checks.argument(("verbs", name, *place), argument, known[name], key="type")
            if verb.write and keys.sequence is not None and keys.sequence.write is None:
                what = "is written, and sequence has no write, the variable of its number"
                yield ("verbs", name), f"{what}; add write: ns=2;s=Request to sequence"
            if verb.call is not None and keys.sequence is not None and keys.sequence.busy is not None:
                yield (
                    ("verbs", name),
                    "is a method, and busy says nothing of methods; write it, or give accepted",
                )
            yield from checks.shown_answer(("verbs", name), verb.answer, known[name], ANSWER)


def _arguments(order: Order) -> Iterator[tuple[Place, Argument]]:
    """All arguments and written values, each with its keys."""
    for key in ("given", "write"):
        for at, argument in enumerate(getattr(order, key)):
            yield (key, at), argument


def _ways(keys: OpcUaKeys, device: Device) -> Iterator[Problem]:
    """Problems of a mapping that lacks something which the device's effects or evidence need."""
    sequence, state = keys.sequence, keys.state
    yield from checks.proof(device, "the server", sequence=sequence is not None)
    form, hint = (
        "state: {node: ns=2;s=Belt.State, words: {stopped: 0, moving: 1}}",
        "which method, or what is written, ends",
    )
    shows = state is not None or (sequence is not None and sequence.busy is not None)
    yield from checks.ways(device, form, hint, state=shows, halt=keys.halt is not None)
    if state is not None and state.words:
        yield from checks.states(state.words)
    for key in ("halt", "latch", "clear"):
        order = getattr(keys, key)
        for place, argument in _arguments(order) if order is not None else ():
            yield from checks.plain((key, *place), argument, key)
