"""A tree of a file as the rows that `drawing` takes, with its subtrees in their places."""

from __future__ import annotations

from typing import Any

from .forest import Forest, Node

MOST = 2000  # rows; a picture with more shows nothing
CONTROLS = {"Sequence": "sequence", "Fallback": "selector", "Parallel": "parallel", "RoundRobin": "selector"}


def rows(forest: Forest, tree: str) -> list[dict[str, Any]]:
    """A row for each node, in depth-first order; a tree inside itself is drawn once."""
    drawn: list[dict[str, Any]] = []
    waiting: list[tuple[Node, str, tuple[str, ...]]] = [(forest.trees[tree].root, "", (tree,))]
    while waiting and len(drawn) < MOST:
        node, path, around = waiting.pop()
        drawn.append(
            {"path": path or "root", "name": title(node), "kind": _sign(node.kind), "status": "INVALID"}
        )
        drawn[-1]["feedback"] = ""
        below, within = _below(forest, node, around)
        for number in reversed(range(len(below))):
            waiting.append((below[number], f"{path}.{number}" if path else str(number), within))
    return drawn


def title(node: Node) -> str:
    """The title of a node for people: its own name, or its kind with its values."""
    kind = node.subtree if node.is_subtree else node.kind
    if node.name and node.name != kind:
        return f"{node.name} ({kind})"
    ports = " ".join(f"{name}={attribute.value}" for name, attribute in node.ports.items())
    return f"{kind} {ports}".strip() if len(ports) <= 60 else f"{kind} {ports[:57]}..."


def _below(forest: Forest, node: Node, around: tuple[str, ...]) -> tuple[tuple[Node, ...], tuple[str, ...]]:
    if not node.is_subtree:
        return node.children, around
    name = node.subtree
    if name in around or name not in forest.trees:
        return (), around
    return (forest.trees[name].root,), (*around, name)


def _sign(kind: str) -> str:
    """The word of `drawing` for a kind, found in its name: ReactiveSequence, AsyncFallback."""
    return next((sign for word, sign in CONTROLS.items() if word in kind), "step")
