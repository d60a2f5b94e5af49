"""Checks of the nodes of a forest: kinds, children, ports, scripts, names."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from graphlib import CycleError, TopologicalSorter

from arboleda.drivers import among, quoted
from arboleda.kinds.ranges import comparison
from arboleda.recipes.of_files import Place

from . import (
    ends,
    listed_values,
    names,
    node_results,
    nodes,
    script,
    target_groups,
    values,
    variable_types,
    variables,
)
from .findings import Findings
from .forest import SHARING, Forest, Node
from .markup import Attribute
from .nodes import OF_LIBRARY, Category, Kind, Port, PortDirection
from .values import Variable

MOST_LOOPS = 20
OLD_PARALLEL = ("success_threshold", "failure_threshold", "threshold")
THRESHOLDS = ("success_count", "failure_count", "max_failures", *OLD_PARALLEL)
PARALLELS = ("Parallel", "ParallelAll")


@dataclass(frozen=True, kw_only=True)
class TreeCheck:
    """Result of a check: the number of nodes, and leaves of unknown kinds with the first place of each.

    `has_ring`: a tree contains itself.
    """

    nodes: int
    unknown: Mapping[str, Place]
    has_ring: bool = False


def check(
    forest: Forest,
    findings: Findings,
    allowed: Mapping[str, Kind] | None = None,
    *,
    others_are_checked_elsewhere: bool = False,
) -> TreeCheck:
    """Check a forest and keep all findings. `allowed`: the only kinds of a user's own nodes that there are.

    None: there may be any kinds; those that the files declare count. Nodes of other kinds are passed over
    where they are checked elsewhere.
    """
    checker = _Checker(forest, findings, allowed, others_are_checked_elsewhere)
    for tree in forest.trees.values():
        for node in tree.root.iterate():
            checker.look_at(node)
        for node in node_results.unreached(tree.root):
            sentence = f"{_named(node)} can never be reached, by what stands before it"
            findings.warning(node.place, sentence, kind="never-reached")
    has_ring = _check_loops(forest, findings)
    ends.check(forest, findings)
    target_groups.check(forest, findings)
    listed_values.check(forest, findings)
    for place, name in variables.unwritten(forest, checker.kind):
        sentence = f"the variable {quoted(name)} is read, and nothing in these files writes it"
        findings.warning(place, sentence, kind="variable-that-nothing-writes")
    for clash in variable_types.clashes(forest, checker.kind):
        if all(checker.knows(use.node) for use in (clash.first, clash.other)):
            findings.mistake(clash.other.place, str(clash))
        else:
            findings.warning(clash.other.place, str(clash), kind="types-of-a-variable")
    return TreeCheck(nodes=checker.number, unknown=checker.unknown, has_ring=has_ring)


def _named(node: Node) -> str:
    return f"{node.kind} {quoted(node.name)}" if node.name else node.kind


@dataclass
class _Checker:
    forest: Forest
    findings: Findings
    allowed: Mapping[str, Kind] | None = None
    is_open: bool = False
    number: int = 0
    unknown: dict[str, Place] = field(default_factory=dict)
    around: set[str] = field(default_factory=set)  # unknown kinds with children that were reported

    def kind(self, node: Node) -> Kind | None:
        """The kind of a node, for a subtree that of its model; None if it is unknown."""
        if node.is_subtree:
            return self._model_of(node)
        declared = self.forest.models if self.allowed is None else self.allowed
        allowed = self._built_in(node) or declared.get(node.kind)
        if allowed is None and self.allowed is None and node.tag is not None:
            fewest, most = nodes.children(node.tag)
            allowed = Kind(name=node.kind, category=node.tag, ports=None, fewest=fewest, most=most)
        return allowed

    def knows(self, node: Node) -> bool:
        """True if the kind of a node is known from elsewhere than the model of its file."""
        return self.allowed is not None or self._built_in(node) is not None

    def _built_in(self, node: Node) -> Kind | None:
        """The built-in kind of a node; None where its file declares another kind of this name.

        In a plant, the name of a built-in kind always means that kind.
        """
        is_own = self.allowed is None and node.kind in self.forest.own
        return None if is_own else nodes.built_in(node.kind)

    def _model_of(self, node: Node) -> Kind | None:
        model = self.forest.models.get(node.subtree)
        return model if model is not None and model.category is Category.SUBTREE else None

    def look_at(self, node: Node) -> None:
        self.number += 1
        self._check_names(node)
        for name in names.SCRIPTS:
            if name in node.own:
                self._check_script(node, node.own[name])
        for name in SHARING:
            if name in node.own and node.own[name].value not in values.BOOLS:
                place = node.place_of(node.own[name])
                self.findings.mistake(
                    place, f"{name} must be true or false, is {quoted(node.own[name].value)}"
                )
        if node.is_subtree:
            self._check_subtree(node)
            return
        kind = self.kind(node)
        if kind is None:
            if not self.is_open:
                self._check_unknown(node)
            return
        if kind.ports is None and kind.category in (Category.ACTION, Category.CONDITION):
            self.unknown.setdefault(node.kind, node.place)
        self._check_children(node, kind)
        if kind.ports is not None:
            self._check_ports(node, kind, kind.ports)
        if node.kind in PARALLELS:
            self._check_thresholds(node)

    def _check_names(self, node: Node) -> None:
        if (why := names.of_one_node(node.name)) is not None:
            self._mistake(node, f"a node cannot be called {quoted(node.name)}: {why}")
        if (why := names.of_node(node.kind)) is not None:
            sentence = f"newer editors refuse {quoted(node.kind)} as the name of a node: {why}"
            self.findings.warning(node.place, sentence, kind="name-of-a-node")
        for name, attribute in node.ports.items():
            if (why := names.of_port(name)) is not None:
                place = node.place_of(attribute)
                sentence = f"newer editors refuse {quoted(name)} as the name of a port: {why}"
                self.findings.warning(place, sentence, kind="name-of-a-port")

    def _check_unknown(self, node: Node) -> None:
        """Check a node of a kind that no file declares; a leaf may be of a plant or of a program."""
        near = get_close_matches(node.kind, (*(self.allowed or ()), *OF_LIBRARY), n=1, cutoff=0.8)
        hint = f"; did you mean {near[0]}?" if near else ""
        if node.kind in self.forest.trees:
            self._mistake(node, f'{node.kind} is a tree; write <SubTree ID="{node.kind}"/>')
        elif self.allowed is not None:
            how = "; `arboleda nodes` lists what this plant has"
            self._mistake(node, f"no device of this plant makes a node {node.kind}{hint or how}")
        elif node.children:
            self._warn_of_unknown(node, hint)
        elif near:
            self.findings.warning(node.place, f"nobody here knows {node.kind}{hint}", kind="unknown-leaf")
            self.unknown.setdefault(node.kind, node.place)
        else:
            self.unknown.setdefault(node.kind, node.place)

    def _warn_of_unknown(self, node: Node, hint: str) -> None:
        """Warn once of each unknown kind with children; such a node can still be read and drawn."""
        if node.kind in self.around:
            return
        self.around.add(node.kind)
        category = Category.DECORATOR if len(node.children) == 1 else Category.CONTROL
        declared = f'<{category.value} ID="{node.kind}"/> in the TreeNodesModel'
        how = f"; to have it run, declare {declared} and bring it along"
        sentence = f"nobody here knows {node.kind}, which has children{hint or how}"
        self.findings.warning(node.place, sentence, kind="unknown-node-with-children")

    def _check_children(self, node: Node, kind: Kind) -> None:
        there = len(node.children)
        if kind.fewest <= there <= kind.most:
            return
        if kind.fewest == kind.most:
            needed = f"{kind.fewest}" if kind.most else "none"
        elif kind.most < nodes.MANY:
            needed = f"{kind.fewest} to {kind.most}"
        else:
            needed = f"{kind.fewest} or more" if there < kind.fewest else f"at most {kind.most}"
        word = "child" if there == 1 else "children"
        self._mistake(node, f"{_named(node)} has {there or 'no'} {word}; it needs {needed}")

    def _check_ports(self, node: Node, kind: Kind, ports: Mapping[str, Port]) -> None:
        if kind.some_of and not any(name in node.ports for name in kind.some_of) and self.knows(node):
            some = ", ".join(kind.some_of)
            sentence = f"{_named(node)} is about no fact; give it some of {some}"
            self.findings.warning(node.place, sentence, kind="about-no-fact")
        for name, attribute in node.ports.items():
            if name not in ports:
                self._unknown_port(node, name, attribute, ports)
            else:
                self._check_value(node, ports[name], attribute)
        for port in ports.values():
            if port.is_needed and port.name not in node.ports:
                sentence = f"{_named(node)} needs {port.name}{_what(port)}"
                if self.knows(node):
                    self._mistake(node, sentence)
                elif port.direction is not PortDirection.OUT:
                    self.findings.warning(node.place, sentence, kind="needed-port")

    def _check_thresholds(self, node: Node) -> None:
        """Check thresholds; BehaviorTree.CPP refuses those that the children cannot reach."""
        many = len(node.children)
        for name in THRESHOLDS:
            text = node.port(name) or ""
            if values.INT.fullmatch(text) and values.number(text) > many > 0:
                place = node.place_of(node.ports[name])
                children = f"it has {many} {'child' if many == 1 else 'children'}"
                self.findings.mistake(place, f"{name} of {node.kind} is {text}, and {children}")

    def _unknown_port(self, node: Node, name: str, attribute: Attribute, ports: Collection[str]) -> None:
        shown = [each for each in ports if node.kind != "Parallel" or each not in OLD_PARALLEL]
        place = node.place_of(attribute)
        sentence = f"{node.kind} has no port {quoted(name)}; {among(name, shown)}"
        if self.knows(node):
            self.findings.mistake(place, sentence)
        else:
            hint = f"its model in these files may be outdated: {sentence}"
            self.findings.warning(place, hint, kind="port-that-a-model-lacks")

    def _check_value(self, node: Node, port: Port, attribute: Attribute) -> None:
        if port.type == "script":
            if not isinstance(values.read(port.name, attribute.value), Variable):  # made while the tree runs
                self._check_script(node, attribute)
            return
        value = values.read(port.name, attribute.value)
        place = node.place_of(attribute)
        if isinstance(value, Variable) or (port.can_compare and comparison(value)):
            return
        if port.direction is PortDirection.OUT:
            how = f'version 4 wants {port.name}="{{...}}"'
            sentence = f"{port.name} of {node.kind} names a variable; {how}"
            self.findings.warning(place, sentence, kind="output-that-names-a-variable")
        elif (wanted := values.objection(port.type, value)) is not None:
            self.findings.mistake(place, f"{port.name} of {node.kind} must be {wanted}, is {quoted(value)}")
        elif port.words and value not in port.words:
            sentence = f"{port.name} of {node.kind} is {quoted(value)}; {among(value, port.words)}"
            self.findings.mistake(place, sentence)
        elif port.limits is not None and not port.limits[0] <= values.number(value) <= port.limits[1]:
            lower, upper = port.limits
            sentence = f"{port.name} of {node.kind} must be from {lower:g} to {upper:g}, is {quoted(value)}"
            self.findings.mistake(place, sentence)

    def _check_script(self, node: Node, attribute: Attribute) -> None:
        try:
            script.parse(attribute.value)
        except script.ScriptFault as fault:
            self.findings.mistake(node.place_of(attribute), f"{quoted(attribute.value)}: {fault}")

    def _check_subtree(self, node: Node) -> None:
        name = node.subtree
        if node.children:
            self._mistake(node, f"the SubTree {quoted(name)} has children; they stand in its own tree")
        if name not in self.forest.trees and self.forest.is_whole:
            place = node.place_of(node.own["ID"])
            sentence = f"the tree {quoted(name)} is in none of these files; {among(name, self.forest.trees)}"
            self.findings.warning(place, sentence, kind="tree-that-is-missing")
        model = self._model_of(node)
        if model is None or model.ports is None or node.shares_names:
            return
        for port in model.ports.values():
            if port.is_needed and port.name not in node.ports and not port.name.startswith("_"):
                self._mistake(node, f"the SubTree {quoted(name)} needs {port.name}{_what(port)}")

    def _mistake(self, node: Node, sentence: str) -> None:
        self.findings.mistake(node.place, sentence)


def _what(port: Port) -> str:
    """The type of a port, as the end of a sentence."""
    if port.type == "script":
        return ", a script"
    described = values.TYPES.get(port.type)
    return f": {described[0]}, or a variable" if described else ""


def _check_loops(forest: Forest, findings: Findings) -> bool:
    """Keep a finding for trees that contain themselves; False if there are none."""
    uses = {name: dict(_subtrees(forest, name)) for name in forest.trees}
    for number in range(MOST_LOOPS):
        try:
            TopologicalSorter({name: list(used) for name, used in uses.items()}).prepare()
        except CycleError as error:
            loop = list(reversed(error.args[1]))
            ring = " > ".join(loop)
            findings.mistake(uses[loop[-2]].pop(loop[-1]), f"the tree {loop[-1]} contains itself: {ring}")
        else:
            return number > 0
    return True


def _subtrees(forest: Forest, name: str) -> Iterator[tuple[str, Place]]:
    for node in forest.trees[name].root.iterate():
        if node.is_subtree and node.subtree in forest.trees:
            yield node.subtree, node.place
