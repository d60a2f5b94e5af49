"""A kind of device that is declared as data: its facts, and verbs with what they set and need.

What a verb sets is at once what proves it and what a virtual device makes true; what it needs the plant
refuses to break. A kind that is written in Python may compute what a verb sets and how long it takes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property, partial
from itertools import product
from typing import ClassVar
from unicodedata import normalize

from arboleda.model.commands import Command, Motion, OnStop, Process, Query, Switch, Work
from arboleda.model.errors import ArboledaError
from arboleda.model.facts import Facts, Value, shown
from arboleda.model.messages import Report
from arboleda.model.outside import among, quoted
from arboleda.model.plant_model import Robot
from arboleda.model.recipe import FOR_PEOPLE

Computed = Callable[..., object]
"""A function of a verb's values, by name; one for a virtual device takes the facts before them."""


class UseError(ArboledaError):
    """Error: a kind of device does not have this verb, or the verb does not take this value."""


class Effect(str, Enum):
    """Effect of a verb, as far as the engine must know it."""

    MOTION = "motion"
    PROCESS = "process"
    SWITCH = "switch"
    QUERY = "query"


@dataclass(frozen=True, kw_only=True)
class Slot:
    """Placeholder for the value of a parameter, `$program` in a plant file."""

    name: str


@dataclass(frozen=True, kw_only=True)
class FactType:
    """Type of a fact: one of some words, or any value of a type within limits."""

    type: type[Value]
    words: tuple[Value, ...] = ()
    first: Value  # the first value of a virtual device
    lower: float = -math.inf
    upper: float = math.inf

    def takes(self, value: object) -> bool:
        fits = type(value) is self.type or (self.type is float and type(value) is int)
        if not fits or (self.words and value not in self.words):
            return False
        return not isinstance(value, int | float) or self.lower <= value <= self.upper

    @property
    def is_limited(self) -> bool:
        """True for a number that has limits."""
        return self.upper < math.inf

    def covers(self, other: FactType) -> bool:
        """True if every value of the other type is one of this."""
        if self.words and not other.words:
            return False
        if self.is_limited and not other.words:
            ends = (other.type(other.lower), other.type(other.upper)) if other.is_limited else ()
            return bool(ends) and all(map(self.takes, ends))
        return all(self.takes(value) for value in other.words or (other.first,))

    @property
    def samples(self) -> tuple[Value, ...]:
        """All its words, or else some values of it, the extreme ones among them."""
        if self.type is bool:
            return (False, True)
        ends: tuple[Value, ...] = (self.type(self.lower), self.type(self.upper)) if self.is_limited else ()
        return self.words or tuple(dict.fromkeys((self.first, *ends)))

    def read(self, value: object) -> Value | None:
        """The value as this type has it, where whole numbers are numbers, too; None for any other value.

        How the accent of a word is written does not count.
        """
        if self.type is float and type(value) is int:
            value = float(value)
        if type(value) is str:
            value = normalize("NFC", value)
        return value if self.takes(value) else None  # type: ignore[return-value]

    def allowed(self) -> str:
        """The allowed values in words, for the error on another value."""
        if self.words:
            return ", ".join(map(shown, self.words))
        limits = f" from {self.lower:g} to {self.upper:g}" if self.is_limited else ""
        return TYPES[self.type] + limits


@dataclass(frozen=True, kw_only=True)
class DeviceVerb:
    """Verb of a device, as the engine knows it; times in s. `says_needs`: also where it needs nothing."""

    name: str
    effect: Effect
    parameters: tuple[tuple[str, FactType], ...] = ()
    sets: tuple[tuple[str, Value | Slot], ...] = ()
    needs: Facts = ()
    needs_of_others: Facts = ()  # facts of other devices of the cell, by role: "reader.lid"
    says_needs: bool = field(default=False, compare=False, metadata={FOR_PEOPLE: True})
    takes_s: float = 0.0
    at_most_s: float
    on_stop: OnStop = OnStop.HALT
    works_on_part: bool = False  # there has to be a part at the device
    makes_part: bool = field(default=False, metadata={FOR_PEOPLE: True})  # at a place of the device
    holds: bool = False  # the fact that it sets tells whether the device holds a part
    answers: tuple[Value, ...] = ()  # to a query; the first is what a virtual device answers
    number: FactType | None = field(default=None, metadata={FOR_PEOPLE: True})  # an answer, without a list
    sets_by: Computed | None = None  # the facts by its values, in place of `sets`
    takes_s_by: Computed | None = None  # its time by its values; `takes_s` is then the longest one tried
    virtual: Computed | None = None  # further facts of a virtual device, or its answer, by facts and values
    rate: float = 1.0

    def at_rate(self, rate: float) -> DeviceVerb:
        """The same verb of a device `rate` times as fast; a slower one gets more time."""
        return replace(
            self,
            takes_s=self.takes_s / rate,
            at_most_s=self.at_most_s / min(rate, 1.0),
            rate=self.rate * rate,
        )

    @property
    def samples(self) -> Iterator[Facts]:
        """Values of its parameters, in each way that samples of these can be chosen."""
        names = [name for name, _ in self.parameters]
        for values in product(*(type.samples for _, type in self.parameters)):
            yield tuple(zip(names, values, strict=True))

    @property
    def answer_type(self) -> FactType:
        """The type of a query's answers."""
        if self.number is not None:
            return self.number
        return FactType(type=type(self.answers[0]), words=self.answers, first=self.answers[0])

    @property
    def sets_facts(self) -> bool:
        """True if facts prove the verb."""
        return bool(self.sets) or self.sets_by is not None

    @property
    def held(self) -> tuple[str, Value | Slot]:
        """The name and value of the fact by which this verb, which holds a part, says so."""
        return next(row for row in self.sets if isinstance(self._typical(row[1]), bool))

    def lets_go(self) -> bool:
        """True if the verb can end its device's hold on a part."""
        return self.holds and self.held[1] is not True

    def letting_go(self) -> dict[str, Value]:
        """Values of the parameters with which the verb lets go; others than the fact's have the first."""
        value = self.held[1]
        held = value.name if isinstance(value, Slot) else None
        return {name: False if name == held else type.first for name, type in self.parameters}

    def sets_with(self, values: Mapping[str, Value]) -> Facts:
        """The facts that the verb sets with these values."""
        if self.sets_by is not None:
            return _facts(f"sets of {self.name}", _computed(f"sets of {self.name}", self.sets_by, **values))
        return tuple(
            (name, values[value.name] if isinstance(value, Slot) else value) for name, value in self.sets
        )

    def takes_s_with(self, values: Mapping[str, Value]) -> float:
        """The time that the verb takes with these values, s; raises UseError if its function gives none."""
        if self.takes_s_by is None:
            return self.takes_s
        what = f"takes_s of {self.name}"
        seconds = _computed(what, self.takes_s_by, **values)
        if not isinstance(seconds, int | float) or not 0 <= seconds < math.inf:
            raise UseError(f"{what} must be a time in s, is {quoted(seconds)}")
        return float(seconds) / self.rate

    def _typical(self, value: Value | Slot) -> Value:
        return dict(self.parameters)[value.name].first if isinstance(value, Slot) else value


@dataclass(frozen=True, kw_only=True)
class DeviceKind:
    """Kind of device: the facts that its devices report, and the verbs that they carry out."""

    name: str
    facts: Mapping[str, FactType]
    verbs: Mapping[str, DeviceVerb]

    @cached_property
    def held_fact(self) -> str | None:
        """The name of the fact that says whether a device holds a part; None if the kind has none."""
        holding = (verb.held[0] for verb in self.verbs.values() if verb.holds)
        return next(holding, None)

    def command(self, *, id: str, robot: str, verb: str, values: Mapping[str, Value]) -> Command:
        """The command of a verb with these values; raises UseError, which names the fault."""
        known = self.verbs.get(verb)
        if known is None:
            raise UseError(f"a {self.name} has no verb {quoted(verb)}; {among(verb, self.verbs)}")
        self._check(known, values)
        in_order = tuple((name, values[name]) for name, _ in known.parameters)
        sets = known.sets_with(dict(in_order))
        if known.sets_by is not None:
            self._check_facts(f"{verb} sets", sets)
        return COMMANDS[known.effect](
            id=id, robot=robot, verb=verb, values=in_order, definition=known, made=sets
        )

    def shown_by(self, call: VerbCall, facts: Facts) -> Facts:
        """The further facts that a virtual device shows after this; raises UseError for an invalid one."""
        if call.definition.virtual is None:
            return ()
        what = f"virtual of {call.verb}"
        found = _facts(what, _computed(what, call.definition.virtual, dict(facts), **dict(call.values)))
        self._check_facts(what, found)
        return found

    def answer_of(self, call: VerbCall, facts: Facts) -> Value:
        """The answer of a virtual device to a query; raises UseError if the query has no such answer."""
        type = call.definition.answer_type
        if call.definition.virtual is None:
            return type.first
        what = f"virtual of {call.verb}"
        found = _computed(what, call.definition.virtual, dict(facts), **dict(call.values))
        listed = call.definition.answers
        if found in listed:  # also as an equal value of another type, as 2.0 for 2
            return listed[listed.index(found)]
        answer = type.read(found)
        if answer is None:
            raise UseError(f"{what} answers {quoted(found)}; its answers are {type.allowed()}")
        return answer

    def _check_facts(self, what: str, facts: Facts) -> None:
        for name, value in facts:
            try:
                self.check_fact(name, value)
            except UseError as error:
                raise UseError(f"{what}: {error}") from error

    def check_fact(self, name: str, value: object) -> None:
        """Raises UseError if no device of this kind can report this value."""
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
class VerbCall(Command):
    """Command that a device carries out one of its verbs; `values` are those of its parameters, by name."""

    verb: str
    values: Facts
    definition: DeviceVerb = field(repr=False, compare=False)
    made: Facts = field(repr=False, compare=False)  # the facts that it sets with these values

    @property
    def word(self) -> str:
        return self.verb

    @property
    def given(self) -> dict[str, object]:
        return {"robot": self.robot, "verb": self.verb, **dict(self.values)}

    @property
    def sets(self) -> Facts:
        return self.made

    @property
    def takes_s(self) -> float:
        """The time that a virtual device takes for it, s."""
        return self.definition.takes_s_with(dict(self.values))

    @property
    def needs(self) -> Facts:
        return self.definition.needs

    @property
    def works_on_part(self) -> bool:
        return self.definition.works_on_part

    @property
    def makes_part(self) -> bool:
        return self.definition.makes_part

    @property
    def at_most_s(self) -> float:
        return self.definition.at_most_s


class WorkCall(VerbCall, Work):
    @property
    def on_stop(self) -> OnStop:
        return self.definition.on_stop


class MotionCall(WorkCall, Motion):
    """Command of a verb that moves something of the device."""


class ProcessCall(WorkCall, Process):
    """Command of a verb by which the device works by itself."""


class SwitchCall(VerbCall, Switch):
    """Command of a verb that sets something which stays as it is set."""

    @property
    def grips(self) -> bool | None:
        return bool(dict(self.sets)[self.definition.held[0]]) if self.definition.holds else None


class QueryCall(VerbCall, Query):
    """Command of a verb that asks the device for an answer."""


@dataclass(frozen=True, kw_only=True)
class Device(Robot):
    """Device of a declared kind."""

    kind: DeviceKind
    position_key: ClassVar[str | None] = None

    def at_rate(self, rate: float) -> Device:
        verbs = {name: verb.at_rate(rate) for name, verb in self.kind.verbs.items()}
        return replace(self, kind=replace(self.kind, verbs=verbs))

    @property
    def kind_name(self) -> str:
        return self.kind.name

    @cached_property
    def verb_names(self) -> tuple[str, ...]:
        return tuple(self.kind.verbs)

    @cached_property
    def calls(self) -> Mapping[str, Callable[..., Command]]:
        return {
            " ".join((verb.name, *map(shown, dict(values).values()))): partial(
                self.verb_command, verb.name, values
            )
            for verb in self.kind.verbs.values()
            for values in verb.samples
        }

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

    def verb_command(self, verb: str, values: Facts, *, id: str) -> Command:
        return self.kind.command(id=id, robot=self.name, verb=verb, values=dict(values))

    def let_go(self, *, id: str) -> Command:
        """The command that makes the device let go of a part; raises UseError if its kind has none."""
        for verb in self.kind.verbs.values():
            if verb.lets_go():
                return self.kind.command(id=id, robot=self.name, verb=verb.name, values=verb.letting_go())
        raise UseError(f"a {self.kind.name} has no verb that lets go of a part")

    def grip(self, *, id: str) -> Command:
        """The command that takes hold of a part; UseError if that needs further values, or there is none."""
        for verb in self.kind.verbs.values():
            if not verb.holds or verb.held[1] is False:
                continue
            held = verb.held[1]
            others = [name for name, _ in verb.parameters if not isinstance(held, Slot) or name != held.name]
            if others:
                signature = f"{verb.name}({', '.join(f'{name}=...' for name in others)})"
                raise UseError(f"{self.name} is told more to take hold of a part: {signature}")
            values = dict.fromkeys(dict(verb.parameters), True)
            return self.kind.command(id=id, robot=self.name, verb=verb.name, values=values)
        raise UseError(f"a {self.kind.name} has no verb that takes hold of a part")

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


def makes_parts(robot: Robot) -> bool:
    """True for a device with a verb that makes a part."""
    return isinstance(robot, Device) and any(verb.makes_part for verb in robot.kind.verbs.values())


def verbs_of(robot: Robot) -> tuple[DeviceVerb, ...]:
    """The verbs of a device of a declared kind; none of any other robot."""
    return tuple(robot.kind.verbs.values()) if isinstance(robot, Device) else ()


def _computed(what: str, function: Computed, *facts: object, **values: Value) -> object:
    """The result of a kind's own function; an exception in it is raised as UseError with its text."""
    try:
        return function(*facts, **values)
    except Exception as error:  # user code: any exception is reported
        raise UseError(f"{what}: {type(error).__name__}: {error}") from error


def _facts(what: str, found: object) -> Facts:
    if not isinstance(found, Mapping):
        raise UseError(f"{what} must be facts by name, is {quoted(found)}")
    return tuple(found.items())


COMMANDS: dict[Effect, type[VerbCall]] = {
    Effect.MOTION: MotionCall,
    Effect.PROCESS: ProcessCall,
    Effect.SWITCH: SwitchCall,
    Effect.QUERY: QueryCall,
}
TYPES: dict[type, str] = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
