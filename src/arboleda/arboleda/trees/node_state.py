"""State of a tree's nodes that is kept for the next start, with their last commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from py_trees.common import Status

from arboleda.dispatch.ledger import Entry, State
from arboleda.model.by_class import nearest
from arboleda.model.commands import Command, Motion, Query, Switch, Work

MOTION, PROCESS, SWITCH, QUERY, OTHER = "motion", "process", "switch", "query", "other"
EFFECTS = {Motion: MOTION, Work: PROCESS, Switch: SWITCH, Query: QUERY, Command: OTHER}


class Keeps:
    """Node of ours: the state of it that is kept for the next start, and how it goes on then.

    `ends_unkept`: only its status is kept, unless it is RUNNING.
    """

    ends_unkept = False
    status: Status

    def kept(self) -> Mapping[str, Any] | None:
        """The state to keep of it beside its status."""
        return None

    def restore(self, state: Mapping[str, Any]) -> None:
        """Take over the state that was kept."""

    def begin_anew(self) -> None:
        """Begin once more, with all times from now on."""


def command_kept(entry: Entry | None) -> dict[str, Any] | None:
    """The record of the last command of a step; None where none may have left."""
    if entry is None or not entry.was_sent:
        return None
    command = entry.command
    return {
        "robot": command.robot,
        "effect": nearest(EFFECTS, type(command)),
        "goal": entry.positions[-1] if entry.positions else None,
        "sets": entry.sets,
        "grips": command.grips if isinstance(command, Switch) else None,
        "before": entry.before,
        "number": entry.number,
        "done": entry.state is State.DONE,
    }
