"""Values of the parameters of a tree in a cell: those that all nodes accept to which a parameter is given."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from arboleda.drivers import shown
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Limits
from arboleda.recipes import Parameter
from arboleda.recipes.of_files import Place

from . import nodes, target_groups, values
from .findings import Findings
from .forest import Forest, Node
from .nodes import Kind, Port, PortDirection
from .values import NUMBERS, WHOLE, Variable

MOST_LEVELS = 50
LARGEST = 1_000_000_000  # of a number without limits
BOOLS = ("true", "false")
KindsOf = Callable[[Cell], Mapping[str, Kind]]


@dataclass(frozen=True)
class _ValueSet:
    """Values of a parameter; `words` are all values, or examples within the limits of a number."""

    words: Sequence[str]
    limits: Limits | None = None


@dataclass(frozen=True)
class _ParameterUse:
    """Port that is given a parameter."""

    node: Node
    port: Port
    place: Place


def of_tree(forest: Forest, main: str) -> list[Port]:
    """The ports of a tree that are its parameters."""
    ports = forest.declared_ports(main).values()
    return [each for each in ports if each.direction is PortDirection.IN]


def parameter(
    forest: Forest,
    main: str,
    port: Port,
    kinds: KindsOf,
    *,
    group: str | None,
    listed: Sequence[str] | None = None,
    names_place: bool = False,
) -> Parameter:
    """The recipe's parameter for a port of its main tree; `kinds` are the leaves of a cell.

    `group` is the group of targets that its values come from, `listed` are its values, where the tree has a
    list. `names_place`: the end of the tree states the parts there, so that the value must be a place.
    """

    def allowed(cell: Cell) -> _ValueSet:
        uses = [use.port for use in _uses(forest, kinds(cell), main, port.name, 0)]
        values_here = _allowed(port, uses)
        if listed is not None:
            values_here = _ValueSet(
                [each for each in listed if all(_takes(taking, each) for taking in (port, *uses))]
            )
        if group is not None:
            targets = target_groups.words(cell, group)
            values_here = _ValueSet(
                [each for each in targets if each in values_here.words or not values_here.words]
            )
        if not names_place:
            return values_here
        places = {place.target for place in cell.places}
        return _ValueSet([word for word in values_here.words if word in places])

    def value(cell: Cell, word: str) -> object:
        limits = allowed(cell).limits
        if limits is not None:
            return int(word) if limits.whole else float(word)
        if values.objection(port.type, word) is not None:
            return word  # the tree is refused for that
        return _as(port.type, word)

    return Parameter(
        name=port.name,
        words=lambda cell: allowed(cell).words,
        value=value,
        limits=lambda cell: allowed(cell).limits,
    )


def handed_on(forest: Forest, main: str) -> frozenset[str]:
    """The parameters of a tree that a node or a subtree in it is given, whatever that makes of it."""
    nodes_there = list(forest.trees[main].root.iterate())
    names = [port.name for port in of_tree(forest, main)]
    return frozenset(name for name in names if any(any(_ports_with(node, name)) for node in nodes_there))


def check(forest: Forest, main: str, kinds: Mapping[str, Kind], findings: Findings) -> None:
    """Keep a finding for each parameter of the tree that is given to a port of another type."""
    for port in of_tree(forest, main):
        for use in _uses(forest, kinds, main, port.name, 0):
            if not values.fits(port.type, use.port.type):
                wanted = f"{use.port.name} of {use.node.kind} must be {values.TYPES[use.port.type][0]}"
                sentence = f"{wanted}; the port {port.name} of {main} is declared as {port.type}"
                findings.mistake(use.place, sentence)


def _as(type: str, word: str) -> object:
    """The value of this type that a word means."""
    if type == "bool":
        return word == "true"
    return values.number(word) if type == "double" else int(values.number(word)) if type in WHOLE else word


def _allowed(port: Port, uses: Sequence[Port]) -> _ValueSet:
    """The values of a parameter that all of these ports accept."""
    is_one_type = all(values.fits(port.type, each.type) for each in uses)
    all_of_it = [port, *uses] if is_one_type else uses  # else `check` refuses the tree
    listed = [each.words or BOOLS for each in all_of_it if each.words or each.type == "bool"]
    if listed:
        return _ValueSet([each for each in listed[0] if all(_takes(taking, each) for taking in all_of_it)])
    if not any(each.type in NUMBERS for each in all_of_it):
        return _ValueSet([])
    limits = _limits(all_of_it)
    if limits.lower > limits.upper:
        return _ValueSet([])
    has_limits = any(each.limits is not None for each in uses)
    examples = (limits.lower, limits.upper) if has_limits else (1, 2)
    read = int if limits.whole else float
    return _ValueSet([shown(read(each)) for each in examples], limits)


def _takes(port: Port, word: str) -> bool:
    if values.objection(port.type, word) is not None or (port.words and word not in port.words):
        return False
    if port.type == "bool" and word not in BOOLS:
        return False
    return port.limits is None or port.limits[0] <= values.number(word) <= port.limits[1]


def _limits(ports: Sequence[Port]) -> Limits:
    """The limits within which all of the ports take a number."""
    lowest = [0.0 for each in ports if each.type in ("unsigned", "msec")]
    ends = [each.limits for each in ports if each.limits is not None]
    lower = max([-LARGEST, *lowest, *(each[0] for each in ends)])
    upper = min([LARGEST, *(each[1] for each in ends)])
    if any(each.type in WHOLE for each in ports):
        return Limits(lower=math.ceil(lower), upper=math.floor(upper), whole=True)
    return Limits(lower=float(lower), upper=float(upper))


def _uses(
    forest: Forest, kinds: Mapping[str, Kind], tree: str, name: str, level: int
) -> Iterator[_ParameterUse]:
    """Each port that is given a variable, in a tree and in its subtrees."""
    if level > MOST_LEVELS or tree not in forest.trees:
        return
    for node in forest.trees[tree].root.iterate():
        for port_name in _ports_with(node, name):
            if node.is_subtree:
                yield from _uses(forest, kinds, node.subtree, port_name, level + 1)
                continue
            kind = nodes.built_in(node.kind) or kinds.get(node.kind)
            port = (kind.ports or {}).get(port_name) if kind is not None else None
            if port is not None and port.direction is not PortDirection.OUT:
                yield _ParameterUse(node, port, node.place_of(node.ports[port_name]))


def _ports_with(node: Node, variable: str) -> Iterator[str]:
    """The ports of a node that are given a variable."""
    for name, attribute in node.ports.items():
        value = values.read(name, attribute.value)
        if isinstance(value, Variable) and value.name == variable:
            yield name
    if node.shares(variable):
        yield variable
