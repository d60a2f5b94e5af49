"""Builder of running nodes, with their variables, from a tree of a file; `devices` makes the leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

from arboleda.recipes.of_files import TreeError
from arboleda_trees.bt_xml import names, nodes, script, values
from arboleda_trees.bt_xml.forest import Forest
from arboleda_trees.bt_xml.forest import Node as Written
from arboleda_trees.bt_xml.nodes import Kind, PortDirection
from arboleda_trees.bt_xml.values import Variable

from . import controls, decorators, leaves, nav2, watching
from .decorators import ALL_DONE, ALL_FAILED, INVERTED, ResultDecorator
from .memory import Scope, Value
from .node import FAILURE, RUNNING, SKIPPED, SUCCESS, Clock, Node
from .ports import NodePorts
from .scripts import Script

Leaf = Callable[[Written, "list[Node]", Scope], "Node | None"]
"""Makes the node of a user's own kind, around the nodes below it; None for an unknown kind."""
Make = Callable[[str, "list[Node]", NodePorts], Node]


@dataclass(frozen=True)
class Builder:
    """Builder of the nodes of a forest's trees."""

    forest: Forest
    leaf: Leaf
    time: Clock
    kinds: Mapping[str, Kind] = field(default_factory=dict)  # of the leaves
    controls: Mapping[str, Make] = field(default_factory=dict)  # by kind: used in place of MAKERS
    written: list[tuple[Scope, str]] = field(default_factory=list)  # every variable that may get a value
    errors: list[TreeError] = field(default_factory=list)  # of leaves that could not be made

    def tree(self, name: str, scope: Scope) -> Node:
        """The nodes of a tree."""
        return self._node(self.forest.trees[name].root, scope)

    def _node(self, node: Written, scope: Scope) -> Node:
        made = self._subtree(node, scope) if node.is_subtree else self._made(node, scope)
        made.scope, made.place, made.said = scope, node.place, _said(node)
        made.writes = tuple(scope.place(name) for name in sorted(self._writes(node)))
        self.written.extend(made.writes)
        made.time = self.time
        scripts = {name: Script.of(node.own[name].value) for name in names.SCRIPTS if name in node.own}
        made.before = {name: script for name, script in scripts.items() if name in names.PRE}
        made.after = {name: script for name, script in scripts.items() if name in names.POST}
        return made

    def _made(self, node: Written, scope: Scope) -> Node:
        below = [self._node(child, scope) for child in node.children]
        make = self.controls.get(node.kind) or MAKERS.get(node.kind)
        if make is not None:
            texts = {name: attribute.value for name, attribute in node.ports.items()}
            return make(_said(node) or node.kind, below, NodePorts(node.kind, texts))
        try:
            leaf = self.leaf(node, below, scope)
        except TreeError as error:
            self.errors.append(error)
            return leaves.ConstantLeaf(node.kind, FAILURE)
        if leaf is None:
            raise TreeError(f"Arboleda does not run {node.kind}", node.place)
        return leaf

    def _subtree(self, node: Written, scope: Scope) -> Node:
        name = node.subtree
        passed: dict[str, Value | Variable] = {}
        for port in () if node.shares_names else self.forest.declared_ports(name).values():
            if port.default is not None:
                passed[port.name] = values.read(port.name, port.default)
        for port_name, attribute in node.ports.items():
            passed[port_name] = values.read(port_name, attribute.value)
        inner = Scope(
            around=scope,
            names={key: value.name for key, value in passed.items() if isinstance(value, Variable)},
            shares=node.shares_names,
            values={key: _typed(value) for key, value in passed.items() if not isinstance(value, Variable)},
        )
        return decorators.SubTree(node.name or name, [self.tree(name, inner)])

    def _writes(self, node: Written) -> set[str]:
        """The variables that a node may set."""
        variables: set[str] = set()
        scripts = [node.own[name].value for name in names.SCRIPTS if name in node.own]
        kind = nodes.built_in(node.kind) or self.kinds.get(node.kind)
        for port in (kind.ports or {}).values() if kind is not None else ():
            if port.name not in node.ports:
                continue
            text = node.ports[port.name].value
            if port.type == "script":
                scripts.append(text)
            elif port.direction is not PortDirection.IN or node.kind == "UnsetBlackboard":
                value = values.read(port.name, text)
                variables.add(value.name if isinstance(value, Variable) else value)
        return variables.union(*(script.writes(script.parse(text)) for text in scripts))


def _typed(value: Value) -> Value:
    """A number if a text spells one, so that scripts can calculate with it; else the text."""
    text = str(value)
    if values.objection("int", text) is None:
        return int(values.number(text))
    return values.number(text) if values.objection("double", text) is None else value


def control(kind: Callable[[str, list[Node]], Node]) -> Make:
    return lambda name, below, ports: kind(name, below)


def _with_ports(kind: Callable[[str, list[Node], NodePorts], Node]) -> Make:
    return lambda name, below, ports: kind(name, below, ports)


def _around(kind: Callable[[str, Node, NodePorts], Node]) -> Make:
    return lambda name, below, ports: kind(name, below[0], ports)


def _for_each(name: str, below: list[Node], ports: NodePorts) -> Node:
    return decorators.ForEach(name, below[0], ports, source="vector_in", out="out")


def _loop(name: str, below: list[Node], ports: NodePorts) -> Node:
    return decorators.ForEach(name, below[0], ports, source="queue", out="value")


def _said(node: Written) -> str:
    """The name of a node; for an AlwaysFailure without a name, its note, which says why it fails."""
    note = node.own.get("_description") if node.kind == "AlwaysFailure" else None
    return node.name or (note.value if note is not None else "")


def _check(name: str, below: list[Node], ports: NodePorts, *, same: Callable[[Value, Value], bool]) -> Node:
    return watching.BlackboardCheck(name, below[0], ports, same)


def _alone(kind: Callable[[str, NodePorts], Node]) -> Make:
    return lambda name, below, ports: kind(name, ports)


MAKERS: Mapping[str, Make] = {
    "Sequence": control(controls.InSequence),
    "AsyncSequence": control(controls.AsyncSequence),
    "SequenceWithMemory": control(controls.SequenceWithMemory),
    "ReactiveSequence": control(controls.ReactiveSequence),
    "Fallback": control(controls.InFallback),
    "AsyncFallback": control(controls.AsyncFallback),
    "ReactiveFallback": control(controls.ReactiveFallback),
    "TryCatch": control(controls.TryCatch),
    "Parallel": _with_ports(controls.Parallel),
    "ParallelAll": _with_ports(controls.ParallelAll),
    "IfThenElse": control(controls.IfThenElse),
    "WhileDoElse": control(controls.WhileDoElse),
    **{f"Switch{number}": _with_ports(controls.Switch) for number in range(2, 7)},
    "RecoveryNode": _with_ports(nav2.RecoveryNode),
    "PipelineSequence": control(nav2.PipelineSequence),
    "RoundRobin": _with_ports(nav2.RoundRobin),
    "NonblockingSequence": control(nav2.NonblockingSequence),
    "PersistentSequence": _with_ports(nav2.PersistentSequence),
    "SingleTrigger": _around(watching.SingleTrigger),
    "GoalUpdatedController": _around(watching.GoalUpdatedController),
    "RateController": _around(decorators.RateController),
    "Inverter": lambda name, below, ports: ResultDecorator(name, below[0], INVERTED),
    "ForceSuccess": lambda name, below, ports: ResultDecorator(name, below[0], ALL_DONE),
    "ForceFailure": lambda name, below, ports: ResultDecorator(name, below[0], ALL_FAILED),
    "KeepRunningUntilFailure": control(decorators.KeepRunningUntilFailure),
    "Repeat": lambda name, below, ports: decorators.Loop(
        name, below[0], ports, port="num_cycles", goes_on=SUCCESS
    ),
    "RetryUntilSuccessful": lambda name, below, ports: decorators.Loop(
        name, below[0], ports, port="num_attempts", goes_on=FAILURE
    ),
    "Timeout": lambda name, below, ports: decorators.Timeout(name, below[0], ports, "msec"),
    "Delay": lambda name, below, ports: decorators.Delay(name, below[0], ports, "delay_msec"),
    "RunOnce": _around(decorators.RunOnce),
    "Precondition": _around(decorators.Precondition),
    "ForEach": _for_each,
    **dict.fromkeys(("LoopInt", "LoopBool", "LoopDouble", "LoopString"), _loop),
    "SkipUnlessUpdated": lambda name, below, ports: watching.WhenUpdated(name, below[0], ports, SKIPPED),
    "WaitValueUpdate": lambda name, below, ports: watching.WhenUpdated(name, below[0], ports, RUNNING),
    **{kind: partial(_check, same=same) for kind, same in watching.SAME.items()},
    "WasEntryUpdated": _alone(watching.WasEntryUpdated),
    "AlwaysSuccess": lambda name, below, ports: leaves.ConstantLeaf(name, SUCCESS),
    "AlwaysFailure": lambda name, below, ports: leaves.AlwaysFailure(name),
    "Script": lambda name, below, ports: leaves.RunScript(name, ports.texts["code"]),
    "ScriptCondition": lambda name, below, ports: leaves.ScriptCondition(name, ports.texts["code"]),
    "SetBlackboard": _alone(leaves.SetBlackboard),
    "UnsetBlackboard": _alone(leaves.UnsetBlackboard),
    "Sleep": _alone(leaves.Sleep),
}
