"""A tree as text: an outline of ASCII characters, and the language of Graphviz."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .layout import depth, parent
from .picture import LOOKS

KINDS = {"selector": "{o}", "sequence": "{-}", "parallel": "/_/"}  # those of py_trees, with memory
LEAF = "-->"
STATUSES = {"INVALID": "[-]", "RUNNING": "[*]", "SUCCESS": "[o]", "FAILURE": "[x]"}


def outline(rows: Sequence[dict[str, Any]], *, statuses: bool = False) -> str:
    """An outline with a line per node; with `statuses` each has its result and its message."""
    return "".join(_line(row, statuses) for row in rows)


def _line(row: dict[str, Any], statuses: bool) -> str:
    status = f" {STATUSES[row['status']]}" if statuses else ""
    status += f" -- {row['feedback']}" if statuses and row["feedback"] else ""
    return f"{'    ' * depth(row['path'])}{KINDS.get(row['kind'], LEAF)} {row['name']}{status}\n"


def dot(rows: Sequence[dict[str, Any]]) -> str:
    """The tree in the language of Graphviz: `dot -Tpdf` draws it."""
    nodes = [_dot_node(row) for row in rows]
    edges = [f'  "{above}" -> "{row["path"]}";' for row in rows if (above := parent(row["path"]))]
    head = 'digraph tree {\n  rankdir=LR;\n  node [shape=box, style="rounded,filled", fontname="sans-serif"];'
    return "\n".join([head, *nodes, *edges, "}\n"])


def _dot_node(row: dict[str, Any]) -> str:
    look = LOOKS[row["status"]]
    sign = {"selector": "? ", "sequence": "→ ", "parallel": "⇉ "}.get(row["kind"], "")
    label = (sign + str(row["name"])).replace("\\", r"\\").replace('"', r"\"")
    return f'  "{row["path"]}" [label="{label}", fillcolor="{look.fill}", color="{look.edge}"];'
