"""Variables that are given to ports of two types: BehaviorTree.CPP refuses such a tree when it makes it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from arboleda.recipes.of_files import Place

from . import values
from .forest import Forest, Node, Tree
from .nodes import Kind
from .values import OUTER, Variable

KindOf = Callable[[Node], "Kind | None"]
SAME: Mapping[str, str] = {"msec": "unsigned", "script": "string", "status": "NodeStatus"}
TEXT = "string"
MOST_PASSED = 100_000  # variables of inner trees that are compared with those of outer trees


@dataclass(frozen=True, kw_only=True)
class VariableUse:
    """Port that is given a variable; `type` is "" if it is unknown, or if the port takes any value."""

    node: Node
    port: str
    type: str

    @property
    def place(self) -> Place:
        return self.node.place_of(self.node.ports[self.port])

    def __str__(self) -> str:
        return f"{self.port} of {self.node.kind} ({self.type})"


@dataclass(frozen=True, kw_only=True)
class Clash:
    """Variable with the use that decides its type, and a use of another type."""

    variable: str
    first: VariableUse
    other: VariableUse

    def __str__(self) -> str:
        there = f"{self.first} at {self.first.place}"
        why = "BehaviorTree.CPP refuses a variable of two types; take one for each"
        return f"{{{self.variable}}} is given to {there} and to {self.other}; {why}"


@dataclass
class _Uses:
    """First use of a variable, which decides its type, and the first use of each type."""

    first: VariableUse
    typed: dict[str, VariableUse] = field(default_factory=dict)

    def all(self) -> Iterator[VariableUse]:
        yield self.first
        yield from self.typed.values()

    def add(self, use: VariableUse) -> None:
        if use.type:
            self.typed.setdefault(use.type, use)

    def clashes(self, use: VariableUse) -> bool:
        """True if a use is of another type than the first use. After a text, or any value, all types fit."""
        return bool(self.first.type and use.type) and self.first.type not in (TEXT, use.type)


def clashes(forest: Forest, kind: KindOf) -> list[Clash]:
    """The clashes in all trees; an outer tree and its subtrees may share a variable."""
    conflicts: list[Clash] = []
    inner_uses: dict[str, Mapping[str, _Uses]] = {}
    passed = 0
    for name in _inner_first(forest):
        there: dict[str, _Uses] = {}
        for variable, use in _in_order(forest.trees[name], forest, kind, inner_uses):
            uses = there.setdefault(variable, _Uses(use))
            if uses.clashes(use):
                conflicts.append(Clash(variable=variable, first=uses.first, other=use))
            uses.add(use)
        passed += len(there)
        inner_uses[name] = there if passed <= MOST_PASSED else {}
    return conflicts


def _inner_first(forest: Forest) -> list[str]:
    """The trees, each after the trees that it contains.

    In a ring of trees, which `checking` reports, one comes too early.
    """
    ordered: dict[str, None] = {}
    begun: set[str] = set()
    waiting = list(forest.trees)
    while waiting:
        name = waiting[-1]
        inner = [] if name in begun else forest.inside(name)
        begun.add(name)
        if more := [each for each in inner if each not in begun]:
            waiting += more
        else:
            ordered.setdefault(waiting.pop())
    return list(ordered)


def _in_order(
    tree: Tree, forest: Forest, kind: KindOf, inner_uses: Mapping[str, Mapping[str, _Uses]]
) -> Iterator[tuple[str, VariableUse]]:
    """The uses of a tree's variables in the order in which BehaviorTree.CPP makes the nodes."""
    for node in tree.root.iterate():
        if not node.is_subtree:
            yield from sorted(_of_node(node, kind(node)), key=lambda row: row[1].type != TEXT)
            continue
        for inner, uses in inner_uses.get(node.subtree, {}).items():
            outer = _outside(node, inner, forest)
            if outer is not None:
                yield from ((outer, use) for use in uses.all())


def _of_node(node: Node, kind: Kind | None) -> Iterator[tuple[str, VariableUse]]:
    ports = {} if kind is None or kind.ports is None else kind.ports
    for name, attribute in node.ports.items():
        value = values.read(name, attribute.value)
        if isinstance(value, Variable):
            type = ports[name].type if name in ports else ""
            yield value.name, VariableUse(node=node, port=name, type=SAME.get(type, type))


def _outside(node: Node, inner: str, forest: Forest) -> str | None:
    """The name of a subtree's variable in the tree around it; None where it is not passed on."""
    if inner.startswith(OUTER) or node.shares(inner):
        return inner
    written = node.port(inner)
    ports = {} if node.shares_names else forest.declared_ports(node.subtree)
    if written is None and inner in ports:
        written = ports[inner].default
    value = None if written is None else values.read(inner, written)
    return value.name if isinstance(value, Variable) else None
