"""Possible results of nodes, as far as a file shows them, and children that are never reached."""

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
    nodes: list[Node] = []
    _ends(root, nodes)
    return nodes


def _ends(node: Node, unreached: list[Node]) -> Ends:
    """The possible results of a node with its conditions; appends unreached children to `unreached`."""
    certain = ENDS.get(node.kind)
    if certain is not None:
        own = certain
    elif node.children and node.kind in OF_CHILDREN:
        own = OF_CHILDREN[node.kind](node, unreached)
    else:
        for child in node.children:
            _ends(child, unreached)
        own = ANY if node.children or node.is_subtree else EITHER
    return own.union(CONDITIONS[name] for name in CONDITIONS if name in node.own)


def _in_order(stops: str) -> Callable[[Node, list[Node]], Ends]:
    """The results of a node whose children run one after the other, until one has the result `stops`."""
    goes_on = DONE if stops == FAILED else FAILED

    def ends(node: Node, unreached: list[Node]) -> Ends:
        results: set[str] = set()
        all_skip = True
        for number, child in enumerate(node.children):
            below = _ends(child, unreached)
            all_skip = all_skip and SKIPPED in below
            if stops in below:
                results.add(stops)
            if not below - {stops}:
                unreached += node.children[number + 1 : number + 2]
                return frozenset(results)
        return frozenset(results | {goes_on} | ({SKIPPED} if all_skip else set()))

    return ends


def _if_then_else(node: Node, unreached: list[Node]) -> Ends:
    first, *branches = (_ends(child, unreached) for child in node.children)
    results: set[str] = set()
    for needed, number in ((DONE, 1), (FAILED, 2)):
        if number < len(node.children) and needed in first:
            results |= branches[number - 1]
        elif number < len(node.children):
            unreached.append(node.children[number])
    return frozenset(results | ({FAILED} if FAILED in first and len(node.children) < 3 else set()))


def _alone(node: Node, unreached: list[Node]) -> Ends:
    return frozenset().union(*(_ends(child, unreached) for child in node.children))


def _turned(rows: Mapping[str, Iterable[str]]) -> Callable[[Node, list[Node]], Ends]:
    def ends(node: Node, unreached: list[Node]) -> Ends:
        below = _alone(node, unreached)
        return frozenset(end for each in below for end in rows[each])

    return ends


def _for_ever(port: str, remaining: str) -> Callable[[Node, list[Node]], Ends]:
    """The results of a node that repeats; with -1 rounds it never ends by itself, so one result remains."""

    def ends(node: Node, unreached: list[Node]) -> Ends:
        below = _alone(node, unreached)
        value = values.read(port, node.port(port) or "")
        return below & {remaining, SKIPPED} if value == "-1" else ANY

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
