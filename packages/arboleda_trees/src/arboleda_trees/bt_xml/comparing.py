"""Numbers with which scripts of a tree compare something, as far as they are known in advance."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour

from arboleda.kinds.ranges import Range, exactly

from . import script
from .running.memory import Scope
from .running.node import Node
from .running.scripts import Script, ScriptError, evaluate


def compared(tree: Behaviour) -> Iterator[Range]:
    """These numbers, as ranges of one number each."""
    for node in (each for each in tree.iterate() if isinstance(each, Node)):
        for each in (*node.before.values(), *node.after.values(), getattr(node, "script", None)):
            for operand in script.compared(each.statements) if isinstance(each, Script) else ():
                number = _constant(operand, node.scope)
                if number is not None:
                    yield exactly(number)


def _constant(operand: script.Expression, scope: Scope) -> float | None:
    """The number that a part of a script has before the tree runs; None where it has none."""
    if script.writes([operand]):
        return None
    try:
        value = evaluate(operand, scope)
    except ScriptError:
        return None
    return None if isinstance(value, str) else value
