"""Variables that are read but never written: each tree has its own, and gets some from outside."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

from arboleda.recipes.of_files import Place

from . import names, script, values
from .forest import Forest, Node, Tree
from .nodes import Category, Kind, PortDirection
from .values import OUTER, Variable

WORD = re.compile(r"@?[^\W\d]\w*")
KindOf = Callable[[Node], "Kind | None"]


@dataclass
class _TreeVariables:
    """Variables of one tree; `passed` are those that the tree hands to subtrees."""

    read: dict[str, Place] = field(default_factory=dict)
    written: set[str] = field(default_factory=set)
    passed: list[tuple[str, str, str]] = field(default_factory=list)  # own name, tree, name there
    is_open: bool = False  # shares all names with a tree around it or a subtree, or has a script with a fault


def unwritten(forest: Forest, kind: KindOf) -> Iterator[tuple[Place, str]]:
    """Each variable that is read and never written, with the place where it is first read."""
    uses = {name: _use(tree, kind) for name, tree in forest.trees.items()}
    inputs = _inputs(forest, uses)
    outer = {name[1:] for use in uses.values() for name in use.written if name.startswith(OUTER)}
    main = uses.get(forest.main or "")
    outer |= set() if main is None else main.written | inputs[forest.main or ""]
    for name, use in uses.items():
        if use.is_open:
            continue
        given = use.written | inputs[name] | _written_below(use, forest, uses)
        if name == forest.main:
            given |= outer
        for variable, place in use.read.items():
            is_given = variable[1:] in outer if variable.startswith(OUTER) else variable in given
            if not is_given and not (variable.startswith(OUTER) and main is None):
                yield place, variable


def _inputs(forest: Forest, uses: Mapping[str, _TreeVariables]) -> dict[str, set[str]]:
    """The variables that each tree gets from trees around it, or by its own model."""
    inputs: dict[str, set[str]] = defaultdict(set)
    for tree in forest.trees.values():
        for node in tree.root.iterate():
            if not node.is_subtree:
                continue
            name = node.subtree
            inputs[name] |= set(node.ports)
            if node.shares_names:
                uses[tree.name].is_open = True
                uses.get(name, uses[tree.name]).is_open = True  # it may be in no file
    for name, model in forest.models.items():
        if model.category is Category.SUBTREE and model.ports is not None:
            inputs[name] |= set(model.ports)
    return inputs


def _written_below(use: _TreeVariables, forest: Forest, uses: Mapping[str, _TreeVariables]) -> set[str]:
    """The variables of a tree that its subtrees may set."""
    set_inside = set()
    for own, tree, there in use.passed:
        below = uses.get(tree)
        port = forest.declared_ports(tree).get(there)
        is_output = port is not None and port.direction is not PortDirection.IN
        if (
            below is None
            or is_output
            or there in below.written
            or any(there == each[0] for each in below.passed)
        ):
            set_inside.add(own)
    return set_inside


def _use(tree: Tree, kind: KindOf) -> _TreeVariables:
    use = _TreeVariables()
    for node in tree.root.iterate():
        for name in names.SCRIPTS:
            if name in node.own:
                _add_script(use, node.own[name].value, node.place_of(node.own[name]))
        _add_ports(use, node, kind(node))
    return use


def _add_ports(use: _TreeVariables, node: Node, kind: Kind | None) -> None:
    ports = {} if kind is None or kind.ports is None else kind.ports
    for name, attribute in node.ports.items():
        place = node.place_of(attribute)
        port = ports.get(name)
        if port is not None and port.type == "script":
            _add_script(use, attribute.value, place)
            continue
        value = values.read(name, attribute.value)
        if node.kind == "SetBlackboard" and name == "output_key":
            use.written.add(value.name if isinstance(value, Variable) else value)
        elif node.is_subtree and isinstance(value, Variable):
            use.passed.append((value.name, node.subtree, name))
            use.read.setdefault(value.name, place)
        elif isinstance(value, Variable) and (port is None or port.direction is not PortDirection.IN):
            use.written.add(value.name)  # an unknown leaf may do so, too
        elif isinstance(value, Variable):
            use.read.setdefault(value.name, place)
        elif port is not None and port.direction is PortDirection.OUT:
            use.written.add(value)
        elif port is None and not node.is_subtree:
            use.written.update(WORD.findall(value))  # so may a misspelt SetBlackboard or Script


def _add_script(use: _TreeVariables, text: str, place: Place) -> None:
    if isinstance(value := values.read("code", text), Variable):
        use.read.setdefault(value.name, place)
        return
    try:
        statements = script.parse(text)
    except script.ScriptFault:
        use.is_open = True  # the fault is reported elsewhere
        use.written.update(WORD.findall(text))
        return
    for name in sorted(script.reads(statements)):
        use.read.setdefault(name, place)
    use.written |= script.writes(statements)
