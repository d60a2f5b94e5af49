"""Steps of the plant that take values from variables or store answers and facts in variables."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.drivers import ArboledaError, Value, quoted, shown
from arboleda.engine import Act, Await, Failures, Require
from arboleda.kinds.ranges import comparison
from arboleda.model.messages import Failure
from arboleda.recipes import Phrase
from arboleda.recipes.handles import Ask, FactCheck, FactWait, Question
from arboleda_trees.bt_xml import values
from arboleda_trees.bt_xml.nodes import Port

from . import memory
from .memory import Scope
from .node import SUCCESS, Result
from .ports import BETWEEN, LISTED, TYPES, UNSET_AT, WANTED
from .root import Forgiving
from .scripts import ScriptError, spelled

READ: Mapping[str, Callable[[str], Value]] = {
    "int": lambda text: int(values.number(text.strip())),
    "double": lambda text: values.number(text.strip()),
    "bool": lambda text: text.strip().lower() in ("true", "1"),
}
NEEDS_ZONE = Phrase("xml.needs_zone", "{node} would need a zone with these values; write them down")
EXAMPLES: Mapping[str, str] = {"int": "0", "double": "0", "bool": "true"}
MADE_OF: Mapping[type[Behaviour], tuple[str, ...]] = {
    Ask: ("answers", "asked", "make", "anew", "doing", "name", "title"),
    Act: ("make", "anew", "doing", "name", "title"),
    FactCheck: ("obstacle", "facts"),
    FactWait: ("arrived", "seconds", "otherwise", "facts"),
    Require: ("obstacle", "name", "title"),
    Await: ("arrived", "seconds", "otherwise", "name", "title"),
}
"""By class of a step: its attributes that depend on the values of its ports."""


def value_of(kind: str, port: Port, text: str) -> Value:
    """The value that a text means for a port of a device; ScriptError if the port takes no such value."""
    quote = quoted(text)
    if port.can_compare and comparison(text) is not None:
        return text
    if values.objection(port.type, text) is not None:
        raise ScriptError(WANTED(port=port.name, node=kind, wanted=TYPES[port.type](), value=quote))
    if port.words and text not in port.words:
        raise ScriptError(LISTED(port=port.name, node=kind, value=quote, known=port.words))
    if port.limits and not port.limits[0] <= values.number(text) <= port.limits[1]:
        wanted = BETWEEN(lower=port.limits[0], upper=port.limits[1])
        raise ScriptError(WANTED(port=port.name, node=kind, wanted=wanted, value=quote))
    return READ.get(port.type, str)(text)


def example_of(port: Port) -> Value:
    """Any value that a port takes."""
    ends = () if port.limits is None else (f"{port.limits[0]:g}",)
    text = next(iter((*port.words, *ends)), EXAMPLES.get(port.type, "?"))
    return READ.get(port.type, str)(text)


def can_be_renewed(step: Behaviour) -> bool:
    """True if `renew` can give a step other values."""
    return isinstance(step, tuple(MADE_OF))


def renew(step: Behaviour, fresh: Behaviour) -> None:
    """Give a step the values of another step of its kind."""
    row = next(names for kind, names in MADE_OF.items() if isinstance(step, kind))
    for name in row:
        setattr(step, name, getattr(fresh, name))


def as_variable(value: Value) -> memory.Value:
    """A value as a variable holds it: true and false are 1 and 0."""
    return int(value) if isinstance(value, bool) else value


@dataclass(frozen=True, kw_only=True)
class Order:
    """Order of a node to a device: constant values, and variables that are looked up.

    `make` makes the step with these values; ArboledaError where the device takes no such command.
    """

    kind: str
    make: Callable[[dict[str, Value]], Behaviour]
    written: Mapping[str, Value]
    variables: Mapping[str, str] = field(default_factory=dict)  # by port
    ports: Mapping[str, Port] = field(default_factory=dict)

    def values(self, scope: Scope) -> dict[str, Value]:
        """All values of the command, with the present values of variables; ScriptError where one has none."""
        return {name: self._value_of(name, scope) for name in self._given}

    def values_or_examples(self, scope: Scope) -> dict[str, Value]:
        """All values of the command, with any fitting value for a variable that has none yet."""
        unset = {name for name, variable in self.variables.items() if scope.get(variable) is None}
        return {
            name: example_of(self.ports[name]) if name in unset else self._value_of(name, scope)
            for name in self._given
        }

    def words(self, values: Mapping[str, Value], unknown: Collection[str]) -> list[str]:
        """The values for a title, with the names of variables that have no value yet."""
        return [
            f"{{{self.variables[name]}}}" if self.variables.get(name) in unknown else shown(value)
            for name, value in values.items()
        ]

    @property
    def _given(self) -> list[str]:
        """The ports for which the node has a constant or a variable, in the order of its kind."""
        return [name for name in self.ports if name in self.written or name in self.variables]

    def _value_of(self, name: str, scope: Scope) -> Value:
        if name in self.written:
            return self.written[name]
        value = scope.get(self.variables[name])
        if value is None:
            raise ScriptError(UNSET_AT(port=name, node=self.kind, variable=self.variables[name]))
        text = value if isinstance(value, str) else spelled(value)
        return value_of(self.kind, self.ports[name], text)


class DeviceStep(Forgiving):
    """Step of a device. When it begins, it gets the present values of its variables.

    `built` are the values that the step was made with, `anew` the values that it has been given since.
    """

    counts = (*Forgiving.counts, "anew")

    def __init__(
        self,
        name: str,
        step: Behaviour,
        failures: Failures,
        causes: list[Failure],
        order: Order,
        built: Mapping[str, Value],
    ) -> None:
        super().__init__(name, step, failures, causes)
        self.order = order
        self.built = built
        self.anew: dict[str, Value] = {}

    def prepare(self) -> None:
        if self.order.variables and (values := self.order.values(self.scope)) != (self.anew or self.built):
            self._take(values)

    def restore(self, state: Mapping[str, Any]) -> None:
        super().restore(state)
        if "anew" in state:
            self._take(state["anew"])

    def _take(self, values: dict[str, Value]) -> None:
        try:
            fresh = self.order.make(dict(values))
        except ArboledaError as error:
            raise ScriptError(error.sentence) from error
        if type(fresh) is not type(self.step):
            raise ScriptError(NEEDS_ZONE(node=self.order.kind))
        renew(self.step, fresh)
        self.anew = values


class QuestionStep(DeviceStep):
    """Question whose answer is stored in a variable."""

    def __init__(
        self,
        name: str,
        step: Behaviour,
        failures: Failures,
        causes: list[Failure],
        order: Order,
        built: Mapping[str, Value],
        question: Question,
        out: str,
    ) -> None:
        super().__init__(name, step, failures, causes, order, built)
        self.ask = question
        self.out = out

    def work(self) -> Result:
        result = super().work()
        if result is SUCCESS and self.ask.answer is not None:
            self.scope.set(self.out, as_variable(self.ask.answer))
        return result


class FactStep(Forgiving):
    """Condition that stores a device's report in variables; it fails if the device reported nothing."""

    def __init__(
        self,
        name: str,
        step: Behaviour,
        failures: Failures,
        causes: list[Failure],
        read: Callable[[str, str], Value | None],
        facts: Mapping[str, tuple[str, str]],
    ) -> None:
        super().__init__(name, step, failures, causes)
        self.read = read
        self.facts = facts  # by variable: the device and its fact

    def work(self) -> Result:
        result = super().work()
        for variable, fact in self.facts.items() if result is SUCCESS else ():
            if (value := self.read(*fact)) is not None:
                self.scope.set(variable, as_variable(value))
        return result
