"""Variables of trees as XML in the scenes of a walkthrough, and their values after scripts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from arboleda.plant_check.foresight import Scene
from arboleda.plant_check.walkthrough import key_of
from arboleda_trees.bt_xml import script, values
from arboleda_trees.bt_xml.running.memory import Scope, Value
from arboleda_trees.bt_xml.running.ports import NodePorts
from arboleda_trees.bt_xml.running.scripts import Script, ScriptError
from arboleda_trees.bt_xml.values import OUTER, Variable


def scope_in(scope: Scope, names: Iterable[str], scene: Scene) -> Scope | None:
    """The variables of these names with their values in a scene; None where one has no certain value."""
    values = {name: scene.get(*key_of(scope.place(name))) for name in names}
    if None in values.values() or any(name.startswith(OUTER) for name in values):
        return None
    return Scope(values={name: value for name, value in values.items() if value is not None})


def ports_in(scope: Scope, ports: NodePorts, scene: Scene) -> Scope | None:
    """The variables that a node's ports name, with their values in a scene; None as in `scope_in`."""
    read = [values.read(name, text) for name, text in ports.texts.items()]
    return scope_in(scope, [each.name for each in read if isinstance(each, Variable)], scene)


def run(written: Script, scope: Scope, scene: Scene) -> tuple[Value | None, Scene]:
    """The value of a script, None where it is not certain, and the scene after the script.

    ScriptError where the script breaks for certain.
    """
    reads, writes = script.reads(written.statements), script.writes(written.statements)
    variables = scope_in(scope, reads, scene)
    if variables is None or any(name.startswith(OUTER) for name in writes):
        return None, scene.without({key_of(scope.place(name)) for name in writes})
    value = written.run(variables)
    changes = {
        key_of(scope.place(name)): variables.values[name] for name in writes if name in variables.values
    }
    return value, scene.put(changes)


def after_script(written: Script | None, scope: Scope, scenes: Sequence[Scene]) -> Iterator[Scene]:
    """The scenes after a script. A scene in which the script breaks has none: the task has failed."""
    for scene in scenes:
        try:
            yield scene if written is None else run(written, scope, scene)[1]
        except ScriptError:
            continue
