"""Leaves of a tree that command the devices of a cell, or ask for the parts at its places."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from arboleda.drivers import Device, Robot, Value, quoted
from arboleda.engine import Act, Context, Require, framed, titled
from arboleda.model.messages import Failure, Reason
from arboleda.recipes import Phrase, RecipeError, Step, WrittenNode
from arboleda.recipes.handles import Handle, PersonHandle, RobotHandle, handle, question_of
from arboleda.recipes.of_files import TreeError
from arboleda_trees.bt_xml import forest, leaves, values
from arboleda_trees.bt_xml.nodes import Kind, PortDirection
from arboleda_trees.bt_xml.values import Variable

from . import place_steps
from .device_steps import DeviceStep, FactStep, Order, QuestionStep, can_be_renewed, value_of
from .memory import Scope
from .node import Node
from .python_nodes import FunctionNode, WrapperNode
from .root import Forgiving
from .scripts import ScriptError

ANSWER = leaves.ANSWER
UNSAID = Phrase("xml.unsaid", "{robot} has said nothing of {fact}")


@dataclass
class Devices:
    """Factory of the leaves of a tree in a cell.

    The target of a robot must be known when the tree is built, for its path is planned then. So it stands in
    the file, or is a parameter of the recipe. All other values may be any variable.
    """

    context: Context
    causes: list[Failure]
    own: Mapping[str, WrittenNode] = field(default_factory=dict)
    kinds: Mapping[str, Kind] = field(init=False)
    roles: Mapping[str, str] = field(init=False)  # by kind: the role of its device
    fixed: list[tuple[Scope, str, forest.Node]] = field(
        default_factory=list
    )  # variables that must not change

    def __post_init__(self) -> None:
        cell = self.context.cell
        self.kinds = leaves.of_cell(cell, self.own.values())
        self.roles = leaves.roles(cell)

    def make(self, node: forest.Node, below: list[Node], scope: Scope) -> Node | None:
        """The leaf for a node; None for a kind that no device has. TreeError for a wrong command."""
        kind = self.kinds.get(node.kind)
        if kind is None:
            return None
        if node.kind in self.own:
            return self._written(node, kind, self.own[node.kind], below, scope)
        with _placed(node):
            return self._made(node, kind, below, scope)

    def _made(self, node: forest.Node, kind: Kind, below: list[Node], scope: Scope) -> Node:
        if node.kind not in self.roles:
            return self._built(node, kind, scope, partial(place_steps.step, self.context, node.kind))
        role = self.roles[node.kind]
        verb = node.kind.removeprefix(f"{role}_")
        robot = self.context.cell.roles[role]
        if verb == leaves.TELLS and not _has_verb(robot, verb):
            return self._telling(node.name or node.kind, node, robot.name)
        make = partial(_step, handle(robot, self.context), verb, below=below)
        return self._built(node, kind, scope, make, f"{robot.name} {verb}")

    def _built(
        self,
        node: forest.Node,
        kind: Kind,
        scope: Scope,
        make: Callable[[dict[str, Value]], Step],
        words: str = "",
    ) -> Node:
        """The leaf whose step is made of the node's values; `words` name its command without values."""
        name = node.name or node.kind
        order = self._order(node, kind, scope, make)
        built = order.values_or_examples(scope)
        step = order.make(dict(built))
        unknown = [each for each in order.variables.values() if scope.get(each) is None]
        if unknown and type(step) is Act:
            titled(step, " ".join([words, *order.words(built, unknown)]))
        if not can_be_renewed(step):
            self._fix(order, node, scope)
            order = replace(order, variables={})
        failures = self.context.failures
        question = question_of(step)
        if question is not None and ANSWER in node.ports:
            out = _variable(node, ANSWER)
            return QuestionStep(name, step, failures, self.causes, order, built, question, out)
        return DeviceStep(name, step, failures, self.causes, order, built)

    def _written(
        self, node: forest.Node, kind: Kind, written: WrittenNode, below: list[Node], scope: Scope
    ) -> Node:
        """A node in Python; an error of its ports gets the place of the node."""
        name = node.name or node.kind
        inner = [WrapperNode(each, self.context.failures, self.causes) for each in below]
        with _placed(node):
            order = self._order(node, kind, scope, partial(written.build, self.context, inner))
            if not written.is_step:
                outs = {port: _variable(node, port) for port in written.gives if port in node.ports}
                return FunctionNode(name, written, order, outs)
            self._fix(order, node, scope)
            arguments = order.values_or_examples(scope)
        return Forgiving(name, framed(order.make(arguments)), self.context.failures, self.causes)

    def _order(
        self, node: forest.Node, kind: Kind, scope: Scope, make: Callable[[dict[str, Value]], Step]
    ) -> Order:
        ports = {
            name: port for name, port in (kind.ports or {}).items() if port.direction is not PortDirection.OUT
        }
        attributes = {name: values.read(name, node.ports[name].value) for name in ports if name in node.ports}
        written = {
            name: value_of(node.kind, ports[name], each)
            for name, each in attributes.items()
            if not isinstance(each, Variable)
        }
        variables = {name: each.name for name, each in attributes.items() if isinstance(each, Variable)}
        return Order(kind=node.kind, make=make, written=written, variables=variables, ports=ports)

    def _fix(self, order: Order, node: forest.Node, scope: Scope) -> None:
        """Fix the variables, which must not change; raises RecipeError if one has no value yet."""
        for name, variable in order.variables.items():
            place, key = scope.place(variable)
            if place.values.get(key) is None:
                why = "known only while the tree runs; its way has to be known before"
                shown = quoted("{" + variable + "}")
                raise RecipeError(f"{name} of {node.kind} is {shown}, which is {why}")
            self.fixed.append((place, key, node))

    def _telling(self, name: str, node: forest.Node, robot: str) -> Node:
        readers = {fact: partial(self.context.robots.fact, robot, fact) for fact in node.ports}

        def unsaid() -> Failure | None:
            missing = next((fact for fact, read in readers.items() if read() is None), None)
            if missing is None:
                return None
            return Failure(reason=Reason.PRECONDITION, sentence=UNSAID(robot=robot, fact=missing))

        step = Require(leaves.TELLS, self.context.failures, unsaid)
        facts = {_variable(node, fact): (robot, fact) for fact in node.ports}
        return FactStep(name, step, self.context.failures, self.causes, self.context.robots.fact, facts)


def _has_verb(robot: Robot, verb: str) -> bool:
    return isinstance(robot, Device) and verb in robot.kind.verbs


@contextmanager
def _placed(node: forest.Node) -> Iterator[None]:
    """Context in which an error gets the place of the node."""
    try:
        yield
    except (RecipeError, ScriptError) as error:
        raise TreeError(str(error), node.place) from error


def _variable(node: forest.Node, port: str) -> str:
    value = values.read(port, node.ports[port].value)
    return value.name if isinstance(value, Variable) else value


def _step(device: Any, verb: str, arguments: dict[str, Value], *, below: list[Node]) -> Step:
    special = SPECIAL.get((type(device), verb))
    if special is not None:
        return special(device, arguments, below)
    step: Step = getattr(device, verb)(**arguments)
    return step


def _visit(device: Any, arguments: dict[str, Value], below: list[Node]) -> Step:
    step: Step = framed(device.visit(arguments["target"], *below))
    return step


def _ask(device: Any, arguments: dict[str, Value], below: list[Node]) -> Step:
    answers = [each.strip() for each in str(arguments.pop("answers", "done")).split(";")]
    step: Step = device.ask(arguments.pop("question"), answers, **arguments)
    return step


SPECIAL: Mapping[tuple[type[Handle], str], Callable[[Any, dict[str, Value], list[Node]], Step]] = {
    (RobotHandle, "visit"): _visit,
    (PersonHandle, "ask"): _ask,
}
