"""Checks that a tree can be run as a recipe; each finding has its place, and names what to use instead."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from functools import cache

from arboleda.drivers import among, quoted
from arboleda.recipes.of_files import NoDeviceError, TreeMistakes

from . import checking, nodes, parameters, values, variables
from .findings import Findings
from .forest import Forest, Node
from .nodes import Kind, PortDirection
from .values import Variable

MOST_NODES = 2000  # of a recipe, each subtree counted wherever it stands
MOST_LEVELS = 100  # of nodes below each other, through all subtrees
NO_ROBOT_OF_NAV2 = "a device of the plant says where it is: its node ..._says or ..._becomes"
NO = ("false", "False", "FALSE", "0")
INSTEAD: Mapping[str, str] = {
    "ManualSelector": "ask a person of the plant, and take Switch2",
    **dict.fromkeys(("DistanceController", "SpeedController", "PathLongerOnApproach"), NO_ROBOT_OF_NAV2),
    "GoalUpdater": NO_ROBOT_OF_NAV2,
    "PauseResumeController": "an operator holds and resumes a cell",
}
"""By kind of a known node that is not run: what to use instead."""


def part_of(forest: Forest, main: str) -> Forest:
    """The trees that the main tree consists of."""
    trees, waiting = {main: forest.trees[main]}, [main]
    while waiting:
        for name in forest.inside(waiting.pop()):
            if name not in trees:
                trees[name] = forest.trees[name]
                waiting.append(name)
    return replace(forest, trees=trees, main=main)


def check(forest: Forest, findings: Findings) -> bool:
    """Keep a finding for each part of the trees that no cell can run. No tree may contain itself.

    False if the whole tree is too large to look through, each subtree wherever it stands.
    """
    for tree in forest.trees.values():
        for node in tree.root.iterate():
            _check_node(forest, node, findings)
    main = forest.trees[forest.main or ""]
    for port in forest.declared_ports(main.name).values():
        if port.direction is not PortDirection.IN:
            sentence = f"the port {quoted(port.name)} gives a value; a recipe takes values: input_port"
            findings.mistake(main.place, sentence)
    many, levels = _size(forest, main.name)
    if many > MOST_NODES:
        findings.mistake(main.place, f"the whole tree has {many} nodes; a recipe has at most {MOST_NODES}")
    if levels > MOST_LEVELS:
        findings.mistake(
            main.place, f"the whole tree has {levels} levels; a recipe has at most {MOST_LEVELS}"
        )
    return many <= MOST_NODES and levels <= MOST_LEVELS


def check_in_cell(forest: Forest, cell: str, kinds: Mapping[str, Kind], findings: Findings) -> None:
    """Raises TreeMistakes with all faults in a cell with leaves of these kinds, and those in the findings.

    Raises NoDeviceError with all of them if the cell has no device for a node.
    """
    checking.check(forest, findings, kinds, others_are_checked_elsewhere=True)
    parameters.check(forest, forest.main or "", kinds, findings)

    def kind(node: Node) -> Kind | None:
        if node.is_subtree:
            return forest.models.get(node.subtree)
        return nodes.built_in(node.kind) or kinds.get(node.kind)

    for place, name in variables.unwritten(forest, kind):
        findings.mistake(place, f"the variable {quoted(name)} is read, and nothing gives it a value")
    _check_devices(forest, cell, kinds, findings.mistakes)
    if findings.mistakes:
        raise TreeMistakes(findings.mistakes)


def _check_devices(forest: Forest, cell: str, kinds: Mapping[str, Kind], mistakes: Sequence[str]) -> None:
    """Raises NoDeviceError if a cell with leaves of these kinds has no device for a node.

    The error has one place for each kind of such nodes, and the mistakes of other nodes.
    """
    absent: dict[str, NoDeviceError] = {}
    for tree in forest.trees.values():
        for node in tree.root.iterate():
            if not node.is_subtree and nodes.built_in(node.kind) is None and node.kind not in kinds:
                absent.setdefault(node.kind, NoDeviceError(_nobody(node, cell, kinds), node.place))
    if absent:
        first, *others = absent.values()
        raise NoDeviceError(str(first), first.place, others, mistakes)


def _nobody(node: Node, cell: str, kinds: Mapping[str, Kind]) -> str:
    if node.children and not get_close_matches(node.kind, kinds, n=1):
        how = f'write it in Python: @node("{node.kind}")'
        return f"{node.kind} has children and is no node that Arboleda runs; {how}"
    return f"no device of {cell} makes a node {node.kind}; {among(node.kind, sorted(kinds))}"


def _check_node(forest: Forest, node: Node, findings: Findings) -> None:
    if node.is_subtree:
        name = node.subtree
        if name not in forest.trees:
            place = node.place_of(node.own["ID"])
            why = "" if forest.is_whole else "; one that they include is not here: `arboleda check` names it"
            findings.mistake(place, f"the tree {quoted(name)} is in none of these files{why}")
        return
    kind = nodes.built_in(node.kind)
    if kind is None:
        return
    if node.kind in INSTEAD:
        findings.mistake(node.place, f"{node.kind} can be drawn and not be run; {INSTEAD[node.kind]}")
    for name, attribute in node.ports.items():
        port = (kind.ports or {}).get(name)
        place = node.place_of(attribute)
        value = values.read(name, attribute.value)
        if port is not None and port.type == "script" and isinstance(value, Variable):
            sentence = f"{name} of {node.kind} is a variable; write the script itself"
            findings.mistake(place, sentence)
        if name == "catch_on_halt" and value not in NO:
            sentence = (
                f"{name} of {node.kind} must be false: while a tree is left, no device is told anything"
            )
            findings.mistake(place, sentence)
        if port is not None and port.type == "status" and value in ("RUNNING", "IDLE"):
            sentence = f"{name} of {node.kind} must be SUCCESS, FAILURE or SKIPPED: {value} would never end"
            findings.mistake(place, sentence)


def _size(forest: Forest, main: str) -> tuple[int, int]:
    """The number of nodes of a tree with its subtrees, and of its levels."""

    @cache
    def of_tree(name: str) -> tuple[int, int]:
        return of_node(forest.trees[name].root) if name in forest.trees else (0, 0)

    def of_node(node: Node) -> tuple[int, int]:
        below = [of_node(child) for child in node.children]
        if node.is_subtree:
            below.append(of_tree(node.subtree))
        return 1 + sum(many for many, _ in below), 1 + max((levels for _, levels in below), default=0)

    return of_tree(main)
