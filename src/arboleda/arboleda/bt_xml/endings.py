"""Possible results of nodes, as far as they show without running; and children that are never reached."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from . import values
from .forest import Node

Ends = frozenset[str]
DONE, FAILED, SKIPPED = "done", "failed", "skipped"
ANY: Ends = frozenset({DONE, FAILED, SKIPPED})
EITHER: Ends = frozenset({DONE, FAILED})
NEVER: Ends = frozenset()
CONDITIONS = {"_failureIf": FAILED, "_successIf": DONE, "_skipIf": SKIPPED, "_while": SKIPPED}


def unreached(root: Node) -> list[Node]:
    """The nodes that can never be reached; nodes below such a node are left out."""
    found: list[Node] = []
    _ends(root, found)
    return found


def _ends(node: Node, unreached: list[Node]) -> Ends:
    """The possible results of a node with its conditions; unreached children are added to `unreached`."""
    known = ENDS.get(node.kind)
    if known is not None:
        own = known
    elif node.children and node.kind in OF_CHILDREN:
        own = OF_CHILDREN[node.kind](node, unreached)
    else:
        for child in node.children:
            _ends(child, unreached)
        own = ANY if node.children or node.is_subtree else EITHER
    return own.union(CONDITIONS[name] for name in CONDITIONS if name in node.own)


def _in_order(stops: str) -> Callable[[Node, list[Node]], Ends]:
    """The ends of children that run one after the other, until one ends as `stops` says."""
    goes_on = DONE if stops == FAILED else FAILED

    def ends(node: Node, unreached: list[Node]) -> Ends:
        found: set[str] = set()
        all_skip = True
        for number, child in enumerate(node.children):
            below = _ends(child, unreached)
            all_skip = all_skip and SKIPPED in below
            if stops in below:
                found.add(stops)
            if not below - {stops}:
                unreached += node.children[number + 1 : number + 2]
                return frozenset(found)
        return frozenset(found | {goes_on} | ({SKIPPED} if all_skip else set()))

    return ends


def _if_then_else(node: Node, unreached: list[Node]) -> Ends:
    first, *ways = (_ends(child, unreached) for child in node.children)
    found: set[str] = set()
    for needed, number in ((DONE, 1), (FAILED, 2)):
        if number < len(node.children) and needed in first:
            found |= ways[number - 1]
        elif number < len(node.children):
            unreached.append(node.children[number])
    return frozenset(found | ({FAILED} if FAILED in first and len(node.children) < 3 else set()))


def _alone(node: Node, unreached: list[Node]) -> Ends:
    return frozenset().union(*(_ends(child, unreached) for child in node.children))


def _turned(rows: Mapping[str, Iterable[str]]) -> Callable[[Node, list[Node]], Ends]:
    def ends(node: Node, unreached: list[Node]) -> Ends:
        below = _alone(node, unreached)
        return frozenset(end for each in below for end in rows[each])

    return ends


def _for_ever(port: str, kept: str) -> Callable[[Node, list[Node]], Ends]:
    """The ends of a node that repeats; with -1 times without end, only one of them is left."""

    def ends(node: Node, unreached: list[Node]) -> Ends:
        below = _alone(node, unreached)
        value = values.read(port, node.port(port) or "")
        return below & {kept, SKIPPED} if value == "-1" else ANY

    return ends


def _also(*more: str) -> Callable[[Node, list[Node]], Ends]:
    def ends(node: Node, unreached: list[Node]) -> Ends:
        return _alone(node, unreached).union(more)

    return ends


ENDS: Mapping[str, Ends] = {
    "AlwaysSuccess": frozenset({DONE}),
    "AlwaysFailure": frozenset({FAILED}),
    "Script": frozenset({DONE}),
    "SetBlackboard": frozenset({DONE}),
    "UnsetBlackboard": frozenset({DONE}),
    "Sleep": frozenset({DONE}),
}
_SEQUENCE, _FALLBACK = _in_order(FAILED), _in_order(DONE)
OF_CHILDREN: Mapping[str, Callable[[Node, list[Node]], Ends]] = {
    **dict.fromkeys(("Sequence", "AsyncSequence", "SequenceWithMemory", "ReactiveSequence"), _SEQUENCE),
    "PipelineSequence": _SEQUENCE,
    **dict.fromkeys(("Fallback", "AsyncFallback", "ReactiveFallback"), _FALLBACK),
    "IfThenElse": _if_then_else,
    "WhileDoElse": _if_then_else,
    "Inverter": _turned({DONE: (FAILED,), FAILED: (DONE,), SKIPPED: (SKIPPED,)}),
    "ForceSuccess": _turned({DONE: (DONE,), FAILED: (DONE,), SKIPPED: (SKIPPED,)}),
    "ForceFailure": _turned({DONE: (FAILED,), FAILED: (FAILED,), SKIPPED: (SKIPPED,)}),
    "KeepRunningUntilFailure": _turned({DONE: (), FAILED: (FAILED,), SKIPPED: (SKIPPED,)}),
    "Repeat": _for_ever("num_cycles", FAILED),
    "RetryUntilSuccessful": _for_ever("num_attempts", DONE),
    "Timeout": _also(FAILED),
    "Delay": _also(),
}
