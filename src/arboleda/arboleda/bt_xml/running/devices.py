"""The leaves of a tree that are told to the devices of a cell."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from arboleda.bt_xml import forest, leaves, values
from arboleda.bt_xml.nodes import Kind
from arboleda.bt_xml.values import Variable
from arboleda.model.facts import Value
from arboleda.model.messages import Failure
from arboleda.model.outside import quoted
from arboleda.recipes.errors import RecipeError
from arboleda.recipes.handles import Ask, Step, handle
from arboleda.trees.context import Context
from arboleda.trees.steps import framed

from .errors import TreeError
from .memory import Scope
from .node import SUCCESS, Node, Result
from .root import Forgiving

ANSWER = leaves.ANSWER


@dataclass
class Devices:
    """Makes the leaves of a tree in a cell.

    What a device is told has to be known when the tree is built: a value that stands in the file, or a
    parameter of the recipe.
    """

    context: Context
    causes: list[Failure]
    kinds: Mapping[str, Kind] = field(init=False)
    roles: Mapping[str, str] = field(init=False)  # of each kind
    fixed: list[tuple[Scope, str, forest.Node]] = field(
        default_factory=list
    )  # variables that must not change

    def __post_init__(self) -> None:
        cell = self.context.cell
        self.kinds = leaves.of_cell(cell)
        self.roles = {
            name: next(
                role for role in sorted(cell.roles, key=len, reverse=True) if name.startswith(f"{role}_")
            )
            for name in self.kinds
        }

    def make(self, node: forest.Node, below: list[Node], scope: Scope) -> Node | None:
        """The leaf of a node; TreeError where its device cannot be told so, None where no device makes it."""
        kind = self.kinds.get(node.kind)
        if kind is None:
            return None
        try:
            return self._made(node, kind, below, scope)
        except RecipeError as error:
            raise TreeError(str(error), node.place) from error

    def _made(self, node: forest.Node, kind: Kind, below: list[Node], scope: Scope) -> Node:
        role = self.roles[node.kind]
        given = {name: self._value(node, kind, name, scope) for name in node.ports if name != ANSWER}
        device = handle(self.context.cell.roles[role], self.context)
        step = self._step(device, node.kind.removeprefix(f"{role}_"), given, below)
        leaf = Forgiving(node.name or node.kind, step, self.context, self.causes)
        if isinstance(step, Ask) and ANSWER in node.ports:
            return Asking(leaf.name, step, self.context, self.causes, _variable(node))
        return leaf

    def _step(self, device: Any, verb: str, given: dict[str, Value], below: list[Node]) -> Step:
        if verb in SPECIAL:
            return SPECIAL[verb](device, given, below)
        step: Step = getattr(device, verb)(**given)
        return step

    def _value(self, node: forest.Node, kind: Kind, name: str, scope: Scope) -> Value:
        port = (kind.ports or {})[name]
        said = values.read(name, node.ports[name].value)
        if isinstance(said, Variable):
            place, key = scope.place(said.name)
            found = place.values.get(key)
            if found is None:
                why = "known only while the tree runs; a device is told a value, or a parameter of the recipe"
                raise RecipeError(f"{name} of {node.kind} is {quoted('{' + said.name + '}')}, which is {why}")
            self.fixed.append((place, key, node))
            said = str(found)
        if (wanted := values.objection(port.type, said)) is not None:
            raise RecipeError(f"{name} of {node.kind} must be {wanted}, is {quoted(said)}")
        return READ.get(port.type, str)(said)


class Asking(Forgiving):
    """A question, whose answer becomes the value of a variable."""

    def __init__(self, name: str, step: Ask, context: Context, causes: list[Failure], out: str) -> None:
        super().__init__(name, step, context, causes)
        self.ask = step
        self.out = out

    def work(self) -> Result:
        result = super().work()
        if result is SUCCESS and self.ask.answer is not None:
            answer = self.ask.answer
            self.scope.set(self.out, float(answer) if isinstance(answer, bool) else answer)
        return result


def _variable(node: forest.Node) -> str:
    said = values.read(ANSWER, node.ports[ANSWER].value)
    return said.name if isinstance(said, Variable) else said


def _visit(device: Any, given: dict[str, Value], below: list[Node]) -> Step:
    step: Step = framed(device.visit(given["target"], *below))
    return step


def _ask(device: Any, given: dict[str, Value], below: list[Node]) -> Step:
    answers = [each.strip() for each in str(given.pop("answers", "done")).split(";")]
    step: Step = device.ask(given.pop("question"), answers, **given)
    return step


SPECIAL: Mapping[str, Callable[[Any, dict[str, Value], list[Node]], Step]] = {"visit": _visit, "ask": _ask}
READ: Mapping[str, Callable[[str], Value]] = {
    "int": lambda text: int(values.number(text.strip())),
    "double": lambda text: values.number(text.strip()),
    "bool": lambda text: text.strip().lower() in ("true", "1"),
}
