"""Variables of trees as XML in the scenes of a walkthrough, and what scripts make of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from py_trees.behaviour import Behaviour

from arboleda.bt_xml import script, values
from arboleda.bt_xml.running.memory import Scope, Value
from arboleda.bt_xml.running.node import Node
from arboleda.bt_xml.running.ports import NodePorts
from arboleda.bt_xml.running.scripts import Script, ScriptError
from arboleda.bt_xml.values import OUTER, Variable

from .scene import Key, Scene


def key_of(variable: tuple[Scope, str]) -> Key:
    """The key of a variable in scenes."""
    scope, name = variable
    return f"scope {id(scope)}", name


def first_values(tree: Behaviour) -> dict[Key, Value]:
    """The values that variables have when the tree begins: parameters, and constants of subtrees."""
    scopes = {id(node.scope): node.scope for node in tree.iterate() if isinstance(node, Node)}
    return {key_of((each, name)): value for each in scopes.values() for name, value in each.values.items()}


def known_of(scope: Scope, names: Iterable[str], scene: Scene) -> Scope | None:
    """The variables of these names as they are known in a scene; None where one is not."""
    found = {name: scene.get(*key_of(scope.place(name))) for name in names}
    if None in found.values() or any(name.startswith(OUTER) for name in found):
        return None
    return Scope(values={name: value for name, value in found.items() if value is not None})


def ports_in(scope: Scope, ports: NodePorts, scene: Scene) -> Scope | None:
    """The variables that a node's ports name, as they are known in a scene; None where one is not."""
    read = [values.read(name, text) for name, text in ports.texts.items()]
    return known_of(scope, [each.name for each in read if isinstance(each, Variable)], scene)


def run(written: Script, scope: Scope, scene: Scene) -> tuple[Value | None, Scene]:
    """The value of a script, None where it cannot be known, and the scene after it; ScriptError where it
    breaks for certain.
    """
    reads, writes = script.reads(written.statements), script.writes(written.statements)
    known = known_of(scope, reads, scene)
    if known is None or any(name.startswith(OUTER) for name in writes):
        return None, scene.without({key_of(scope.place(name)) for name in writes})
    value = written.run(known)
    changes = {key_of(scope.place(name)): known.values[name] for name in writes if name in known.values}
    return value, scene.put(changes)


def after_script(written: Script | None, scope: Scope, scenes: Sequence[Scene]) -> Iterator[Scene]:
    """The scenes after a script; where it breaks, its task has failed."""
    for scene in scenes:
        try:
            yield scene if written is None else run(written, scope, scene)[1]
        except ScriptError:
            continue
