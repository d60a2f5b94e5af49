"""A kind of device that is declared as data: its facts, and verbs with what they set and need.

What a verb sets is at once what proves it and what a virtual device makes true; what it needs the plant
refuses to break.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import ClassVar

from arboleda.core.commands import Command, Motion, OnStop, Process, Query, Switch, Work
from arboleda.core.errors import ArboledaError
from arboleda.core.facts import Facts, Value, shown
from arboleda.core.messages import Report
from arboleda.core.model import Robot
from arboleda.core.outside import among, quoted


class UseError(ArboledaError):
    """A verb, or a value for it, that a kind of device does not have."""


class Effect(str, Enum):
    """What a verb does, as far as the engine must know it."""

    MOTION = "motion"
    PROCESS = "process"
    SWITCH = "switch"
    QUERY = "query"


@dataclass(frozen=True, kw_only=True)
class Slot:
    """The value of a parameter, `$program` in a plant file."""

    name: str


@dataclass(frozen=True, kw_only=True)
class FactType:
    """What a fact can be: one of some words, or any value of a type."""

    type: type[Value]
    words: tuple[Value, ...] = ()
    first: Value  # what a virtual device begins with

    def takes(self, value: object) -> bool:
        fits = type(value) is self.type or (self.type is float and type(value) is int)
        return fits and (not self.words or value in self.words)

    def read(self, value: object) -> Value | None:
        """The value as this type has it, where whole numbers are numbers, too; None for any other value."""
        if self.type is float and type(value) is int:
            value = float(value)
        return value if self.takes(value) else None  # type: ignore[return-value]

    def allowed(self) -> str:
        """In words, for who gave another value."""
        return ", ".join(map(shown, self.words)) if self.words else TYPES[self.type]


@dataclass(frozen=True, kw_only=True)
class DeviceVerb:
    """One thing that a device can be told; times in s."""

    name: str
    effect: Effect
    parameters: tuple[tuple[str, FactType], ...] = ()
    sets: tuple[tuple[str, Value | Slot], ...] = ()
    needs: Facts = ()
    takes_s: float = 0.0
    at_most_s: float
    on_stop: OnStop = OnStop.HALT
    holds: bool = False  # what it sets says whether the device holds a part
    answers: tuple[Value, ...] = ()  # to a query; the first is what a virtual device answers

    def at_rate(self, rate: float) -> DeviceVerb:
        """The same verb of a faster device, or of a slower one, which is waited for longer."""
        return replace(self, takes_s=self.takes_s / rate, at_most_s=self.at_most_s / min(rate, 1.0))


@dataclass(frozen=True, kw_only=True)
class DeviceKind:
    """What devices of one kind report and can be told."""

    name: str
    facts: Mapping[str, FactType]
    verbs: Mapping[str, DeviceVerb]

    @cached_property
    def held_fact(self) -> str | None:
        """The fact that says whether a device holds a part."""
        holding = (verb.sets[0][0] for verb in self.verbs.values() if verb.holds)
        return next(holding, None)

    def command(self, *, id: str, robot: str, verb: str, values: Mapping[str, Value]) -> Command:
        """The command of a verb; UseError names what is wrong with it."""
        known = self.verbs.get(verb)
        if known is None:
            raise UseError(f"a {self.name} has no verb {quoted(verb)}; {among(verb, self.verbs)}")
        self._check(known, values)
        in_order = tuple((name, values[name]) for name, _ in known.parameters)
        return COMMANDS[known.effect](id=id, robot=robot, verb=verb, values=in_order, told=known)

    def check_fact(self, name: str, value: object) -> None:
        """UseError where no device of this kind can say that."""
        type = self.facts.get(name)
        if type is None:
            raise UseError(f"a {self.name} has no fact {quoted(name)}; {among(name, self.facts)}")
        if not type.takes(value):
            raise UseError(f"{name} is never {quoted(value)}; a {self.name} says {type.allowed()}")

    def _check(self, verb: DeviceVerb, values: Mapping[str, Value]) -> None:
        for name, type in verb.parameters:
            if name not in values:
                raise UseError(f"{verb.name} of a {self.name} needs {name}: {type.allowed()}")
            if not type.takes(values[name]):
                given = quoted(values[name])
                raise UseError(f"{name} of {verb.name} is {given}; a {self.name} takes {type.allowed()}")
        unknown = next((name for name in values if name not in dict(verb.parameters)), None)
        if unknown is not None:
            takes = ", ".join(name for name, _ in verb.parameters) or "none"
            raise UseError(f"{verb.name} of a {self.name} has no {quoted(unknown)}; its values: {takes}")


@dataclass(frozen=True, kw_only=True)
class Told(Command):
    """A verb with its values."""

    verb: str
    values: Facts
    told: DeviceVerb = field(repr=False, compare=False)

    @property
    def given(self) -> dict[str, object]:
        return {"robot": self.robot, "verb": self.verb, **dict(self.values)}

    @property
    def sets(self) -> Facts:
        values = dict(self.values)
        return tuple(
            (name, values[value.name] if isinstance(value, Slot) else value) for name, value in self.told.sets
        )

    @property
    def needs(self) -> Facts:
        return self.told.needs

    @property
    def at_most_s(self) -> float:
        return self.told.at_most_s


class ToldWork(Told, Work):
    @property
    def on_stop(self) -> OnStop:
        return self.told.on_stop


class ToldMotion(ToldWork, Motion):
    """It moves something of the device."""


class ToldProcess(ToldWork, Process):
    """The device works by itself."""


class ToldSwitch(Told, Switch):
    """It sets something that stays as it is set."""

    @property
    def grips(self) -> bool | None:
        return bool(self.sets[0][1]) if self.told.holds else None


class ToldQuery(Told, Query):
    """It asks the device for an answer."""


@dataclass(frozen=True, kw_only=True)
class Device(Robot):
    """A device of a declared kind."""

    kind: DeviceKind
    position_key: ClassVar[str | None] = None

    def at_rate(self, rate: float) -> Device:
        verbs = {name: verb.at_rate(rate) for name, verb in self.kind.verbs.items()}
        return replace(self, kind=replace(self.kind, verbs=verbs))

    @property
    def kind_name(self) -> str:
        return self.kind.name

    @cached_property
    def fact_names(self) -> tuple[str, ...]:
        return tuple(self.kind.facts)

    @property
    def homes(self) -> bool:
        return False

    @property
    def held_fact(self) -> str | None:
        return self.kind.held_fact

    @cached_property
    def works(self) -> bool:
        return any(verb.effect in (Effect.MOTION, Effect.PROCESS) for verb in self.kind.verbs.values())

    def let_go(self, *, id: str) -> Command:
        """The verb that ends its holding a part."""
        for verb in self.kind.verbs.values():
            if verb.holds and verb.sets[0][1] is not True:
                off = {name: False for name, _ in verb.parameters}
                return self.kind.command(id=id, robot=self.name, verb=verb.name, values=off)
        raise UseError(f"a {self.kind.name} has no verb that lets go of a part")

    def objection(self, report: Report) -> str | None:
        for key in ("q", "node", "effector", "piece"):
            if getattr(report, key) is not None:
                return f"{key} was said; {self.name} is a {self.kind.name} and has none"
        for name, value in report.facts or ():
            type = self.kind.facts.get(name)
            if type is None:
                known = ", ".join(self.kind.facts)
                return f"{quoted(name)} is no fact of {self.name}; a {self.kind.name} has {known}"
            if not type.takes(value):
                return f"{name} is {quoted(value)}; {self.name} knows {type.allowed()}"
        return None


COMMANDS: dict[Effect, type[Told]] = {
    Effect.MOTION: ToldMotion,
    Effect.PROCESS: ToldProcess,
    Effect.SWITCH: ToldSwitch,
    Effect.QUERY: ToldQuery,
}
TYPES: dict[type, str] = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
