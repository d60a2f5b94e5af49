"""Nodes that may begin after a node of a tree as XML has succeeded, and how the tree can end then."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from py_trees import composites
from py_trees.behaviour import Behaviour

from arboleda.plant_check.walkthrough import in_order
from arboleda_trees.bt_xml.running.controls import (
    IfThenElse,
    InFallback,
    Parallel,
    ParallelAll,
    ReactiveFallback,
    Switch,
    TryCatch,
    WhileDoElse,
)
from arboleda_trees.bt_xml.running.decorators import ForEach, KeepRunningUntilFailure, Loop, ResultDecorator
from arboleda_trees.bt_xml.running.leaves import ConstantLeaf
from arboleda_trees.bt_xml.running.memory import Scope
from arboleda_trees.bt_xml.running.node import FAILURE, SUCCESS, Result
from arboleda_trees.bt_xml.running.scripts import ScriptError

FALLBACKS = (InFallback, ReactiveFallback, composites.Selector)
AT_ONCE = (Parallel, ParallelAll, composites.Parallel)
REPEATED = (Loop, KeepRunningUntilFailure, ForEach)
Turn = tuple[Sequence[Behaviour], Result | None]
"""Children that may begin after one of them, and the result of their parent; None: it may be either."""


@dataclass(frozen=True, kw_only=True)
class Course:
    """Course of a tree after one of its nodes has succeeded: `later` nodes may begin, each with all below.

    `result` is that of the tree; None where it may be either.
    """

    later: tuple[Behaviour, ...]
    result: Result | None

    @classmethod
    def after(cls, node: Behaviour, *, tree: Behaviour) -> Course:
        later: list[Behaviour] = []
        result: Result | None = SUCCESS
        below = node
        while below is not tree and (above := below.parent) is not None:
            begun, result = _turn(above, above.children.index(below), result)
            later += begun
            below = above
        return cls(later=tuple(each for top in later for each in in_order(top)), result=result)


def needs_all(node: Parallel | ParallelAll) -> bool:
    """True if all children have to succeed, or if a variable says how many."""
    try:
        return node.needs_all(Scope())
    except ScriptError:
        return True


def _turn(above: Behaviour, number: int, result: Result | None) -> Turn:
    """The turn of a parent, whose child of that number has ended with this result."""
    children = above.children
    behind = children[number + 1 :]
    if isinstance(above, ResultDecorator):
        ends = {above.ends[each] for each in ([SUCCESS, FAILURE] if result is None else [result])}
        return [], ends.pop() if len(ends) == 1 else None
    if isinstance(above, REPEATED):
        is_over = isinstance(above, Loop) and result not in (None, above.goes_on)
        return [] if is_over else [above], result
    if isinstance(above, IfThenElse | WhileDoElse) and number == 0:
        return _branches(behind, result)
    if isinstance(above, TryCatch) and not behind:
        return [], FAILURE
    if isinstance(above, Switch | IfThenElse | WhileDoElse):
        return [], result
    if isinstance(above, AT_ONCE):
        return _beside(above, [each for each in children if each is not children[number]])
    return _in_turn(behind, result, SUCCESS if isinstance(above, FALLBACKS) else FAILURE)


def _in_turn(behind: Sequence[Behaviour], result: Result | None, stops: Result) -> Turn:
    """The turn of children of which the next begins until one ends as `stops` says."""
    begun: list[Behaviour] = []
    for child in behind:
        if result is stops:
            break
        begun.append(child)
        certain = _certain(child)
        result = certain if result is not None or certain is stops else None
    return begun, result


def _branches(branches: Sequence[Behaviour], result: Result | None) -> Turn:
    """The turn of a condition: the first branch begins if it succeeded, else the second, if there is one."""
    chosen = {SUCCESS: branches[:1], FAILURE: branches[1:], None: branches}[result]
    ends = {_certain(each) for each in chosen}
    if len(branches) < 2 and result is not SUCCESS:
        ends.add(FAILURE)
    return chosen, ends.pop() if len(ends) == 1 else None


def _beside(above: Behaviour, others: Sequence[Behaviour]) -> Turn:
    """The turn of children at once: one that always fails ends a parallel that needs all of them."""
    is_strict = isinstance(above, Parallel | ParallelAll) and needs_all(above)
    return others, FAILURE if is_strict and FAILURE in map(_certain, others) else None


def _certain(node: Behaviour) -> Result | None:
    """The result of a node that always ends alike; None of any other."""
    return node.result if isinstance(node, ConstantLeaf) and not node.before else None
