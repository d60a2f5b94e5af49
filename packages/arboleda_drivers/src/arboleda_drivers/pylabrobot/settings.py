"""Settings of a device behind PyLabRobot in a plant file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from arboleda.drivers import (
    Device,
    DeviceVerb,
    DriverError,
    Effect,
    Evidence,
    FactType,
    OnStop,
    Robot,
    Value,
    among,
)
from arboleda_drivers.meaning import SCALARS
from arboleda_drivers.plc import checks
from arboleda_drivers.plc.checks import Place, Problem

from .paths import steps
from .reading import Reading

METHOD = re.compile(r"[A-Za-z]\w*(\.[A-Za-z]\w*)*\Z")
LABWARE = re.compile(r"([^\[\]]+)(?:\[([^\[\]]+)\])?\Z")
PARAMETER = re.compile(r"\$([A-Za-z_]\w*)")
PLACE = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z]\w*\Z")


@dataclass(frozen=True, kw_only=True)
class Call:
    """Call of a coroutine of the machine; `$name` is the parameter of the verb.

    `labware` are arguments that lie on the machine, by name, with wells or tips in brackets: `plate[A1:H1]`.
    """

    call: str
    arguments: dict[str, Any] = field(default_factory=dict)
    labware: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if METHOD.match(self.call) is None:
            raise DriverError(f"{self.call} is no method; write it as set_temperature or backend.home")
        for name, value in self.arguments.items():
            each = value if isinstance(value, list | tuple) else [value]
            if value is not None and not all(isinstance(one, SCALARS) for one in each):
                raise DriverError(f"{name} needs a value, or a list of values")
        for name, text in self.labware.items():
            if LABWARE.match(text) is None:
                raise DriverError(f"{name} is {text}; write the labware as plate or plate[A1:H1]")

    @property
    def parameters(self) -> set[str]:
        """The parameters of the verb that it names."""
        texts = [str(one) for value in self.arguments.values() for one in _each(value)]
        return {name for text in (*texts, *self.labware.values()) for name in PARAMETER.findall(text)}

    def filled(self, values: Mapping[str, Value]) -> Call:
        """The same call with these values of the parameters."""

        def text(found: re.Match[str]) -> str:
            return str(values[found[1]])

        def one(value: Any) -> Any:
            named = PARAMETER.fullmatch(value) if isinstance(value, str) else None
            return value if named is None else values[named[1]]

        arguments = {
            name: [one(each) for each in value] if isinstance(value, list | tuple) else one(value)
            for name, value in self.arguments.items()
        }
        labware = {name: PARAMETER.sub(text, value) for name, value in self.labware.items()}
        return replace(self, arguments=arguments, labware=labware)


@dataclass(frozen=True, kw_only=True)
class Verb:
    """Calls for a verb, one after the other, and for a query what the last one's result means."""

    calls: tuple[Call, ...] = ()
    answer: Reading | None = None


@dataclass(frozen=True, kw_only=True)
class MachineMapping:
    """Mapping of one device to a machine of PyLabRobot that a function makes; times in s."""

    facts: dict[str, Reading] = field(default_factory=dict)
    verbs: dict[str, Verb] = field(default_factory=dict)
    halt: tuple[Call, ...] = ()
    latch: tuple[Call, ...] = ()
    clear: tuple[Call, ...] = ()
    cancels: bool = False
    side_by_side: bool = False
    boot: str | None = None
    refusals: tuple[str, ...] = ()
    setup: dict[str, Any] = field(default_factory=dict)
    setup_again: bool = False
    setup_s: float = 300.0
    poll_s: float = 1.0
    timeout_s: float = 5.0
    call_s: float | None = None

    def __post_init__(self) -> None:
        if self.boot is not None:
            steps(self.boot)
        for key, lowest, highest in (("setup_s", 1, 3600), ("poll_s", 0.1, 60), ("timeout_s", 0.5, 60)):
            if not lowest <= getattr(self, key) <= highest:
                raise DriverError(f"{key} is {getattr(self, key):g}; allowed: {lowest:g} to {highest:g}")
        if self.call_s is not None and not 0.5 <= self.call_s <= 86400:
            raise DriverError(f"call_s is {self.call_s:g}; allowed: 0.5 to 86400")

    @property
    def peer(self) -> str:
        """The name of the machine for sentences."""
        return "the machine"

    def problems(self, device: Robot) -> Iterator[Problem]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        return problems(self, device)


@dataclass(frozen=True, kw_only=True)
class Settings(MachineMapping):
    """Settings of the driver `pylabrobot`: what makes the machine, and the mapping of one device."""

    machine: str
    options: dict[str, Any] = field(default_factory=dict)
    backend: str | None = None
    backend_options: dict[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        super().__post_init__()
        for key, place in (("machine", self.machine), ("backend", self.backend)):
            if place is not None and PLACE.match(place) is None:
                raise DriverError(f"{key} is {place}; write module:name, pylabrobot.scales:Scale")
        if self.backend is None and self.backend_options:
            raise DriverError("backend_options are there without backend")

    @property
    def peer(self) -> str:
        return self.machine.partition(":")[2]


def problems(settings: MachineMapping, device: Robot) -> Iterator[Problem]:
    """All problems of the mapping of this device."""
    if not isinstance(device, Device):
        yield from checks.undeclared(device)
        return
    if device.evidence is not Evidence.IDS:
        yield (), f"{device.name} has evidence: {device.evidence.value}; this driver proves ids"
    yield from checks.facts(settings.facts, device, "say where the machine shows it, {read: ...}")
    for name, reading in settings.facts.items():
        if name in device.kind.facts:
            yield from _reading(("facts", name), reading, device.kind.facts[name])
    yield from checks.verbs(settings.verbs, device, "say what is called for it, {calls: [{call: ...}]}")
    for name, verb in settings.verbs.items():
        if name in device.kind.verbs:
            yield from _verb(("verbs", name), verb, device.kind.verbs[name])
    yield from _stops(settings, device)


def _reading(place: Place, reading: Reading, of: FactType) -> Iterator[Problem]:
    if place[0] == "facts" and not reading.read:
        yield place, "read is missing: say where the machine shows it, as get_temperature()"
    if sentence := reading.problem(of):
        yield place, sentence


def _verb(place: Place, verb: Verb, known: DeviceVerb) -> Iterator[Problem]:
    if not verb.calls:
        yield place, f"nothing is called for {known.name}; write calls: [{{call: ...}}]"
    parameters = [name for name, _ in known.parameters]
    for at, call in enumerate(verb.calls):
        for name in sorted(call.parameters - set(parameters)):
            what = f"{known.name} has no parameter {name}"
            yield (*place, "calls", at), f"{what}; {among(name, parameters)}"
    hint = "say what the last call's result means, answer: {words: {...}}"
    yield from checks.answer(place, known, hint, mapped=verb.answer is not None)
    if verb.answer is not None and known.effect is Effect.QUERY:
        yield from _reading((*place, "answer"), verb.answer, known.answer_type)


def _stops(settings: MachineMapping, device: Device) -> Iterator[Problem]:
    for key in ("halt", "latch", "clear"):
        for at, call in enumerate(getattr(settings, key)):
            if call.parameters:
                yield (key, at), f"{key} has no parameters; write values"
    if settings.halt or settings.cancels or not device.has_stop:
        return
    for verb in device.kind.verbs.values():
        if verb.effect in (Effect.MOTION, Effect.PROCESS) and verb.on_stop is OnStop.HALT:
            yield (
                ("halt",),
                f"{verb.name} could not be stopped: say what is called, halt: [{{call: stop_shaking}}], or"
                f" cancels: true; or let it end, on_stop: finish of the verb, or stop: none of the device",
            )
            return


def _each(value: Any) -> list[Any]:
    return list(value) if isinstance(value, list | tuple) else [value]
