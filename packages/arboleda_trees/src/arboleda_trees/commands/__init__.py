"""Commands of the command line that this package adds."""

from __future__ import annotations

from arboleda.extension import Command

COMMANDS = {
    "nodes": Command(
        "arboleda_trees.commands.nodes",
        "List what a tree can tell the devices of a plant, and ask them, with values.",
    ),
}
