"""Tree as plain data: a row for each node with its kind, its parameters, and the time left."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.engine import (
    MAIN,
    RECOVERY,
    Act,
    Announce,
    Await,
    Carry,
    Dwell,
    Require,
    TakeDevices,
    TakeZones,
    Unless,
    is_frame,
    title_of,
)
from arboleda.model.commands import Command

Rows = list[dict[str, Any]]
Times = tuple["float | None", "float | None"]  # s since it began, s left until it is given up
ROOT = "root"  # the path of the root
UNKNOWN: Times = (None, None)
WORDS = {status: status.value for status in Status}
RUNS = WORDS[Status.RUNNING]


def rows(tree: Behaviour, now: float) -> Rows:
    """The rows of a tree in depth-first order; a node is named by its path of child numbers, e.g. `0.2.1`."""
    found: Rows = []
    _add(tree, "", now, found)
    return found


def aged(tree: Behaviour, rows: Rows, now: float) -> Rows:
    """The rows of a tree, to whose nodes nothing has happened since, with the times of now."""
    aged = rows.copy()
    for number, row in enumerate(rows):
        if row["status"] == RUNS:
            since_s, deadline_s = _times(_at(tree, row["path"]), now)
            aged[number] = {**row, "since_s": since_s, "deadline_s": deadline_s}
    return aged


def _at(tree: Behaviour, path: str) -> Behaviour:
    for number in path.split(".") if path != ROOT else ():
        tree = tree.children[int(number)]
    return tree


def progress_of(tree: Behaviour | None) -> float | None:
    """The share of the work's steps that are done, 0 to 1; None where no work runs, a recovery alone too."""
    phases = tree.children if tree is not None else ()
    main = next((phase for phase in phases if phase.name == MAIN), None)
    steps = _steps(main, done=False) if main is not None and main.children else []
    return sum(steps) / len(steps) if steps else None


def _steps(frame: Behaviour, *, done: bool) -> list[bool]:
    """True or False for each step in a frame and its inner frames: it is done; `done`: all of them are.

    Of several ways only the one that is taken counts; until one is, they count as one step.
    """
    nodes = frame.children
    if isinstance(frame, composites.Selector):
        nodes = [node for node in nodes if node.status in (Status.RUNNING, Status.SUCCESS)]
    found: list[bool] = []
    for node in nodes:
        over = done or node.status is Status.SUCCESS
        found += _steps(node, done=over) if is_frame(node) else [over]
    return found or [done]


def _add(node: Behaviour, path: str, now: float, found: Rows) -> None:
    status: Status = node.status
    since_s, deadline_s = _times(node, now) if status is Status.RUNNING else UNKNOWN
    sign, text = _KIND_OF.get(type(node)) or kind(node), getattr(node, "feedback", None)
    feedback = node.feedback_message if text is None else text or ""
    failure = feedback if feedback and status is Status.FAILURE else getattr(node, "last_failure", None)
    found.append(
        {
            "path": path or ROOT,
            "name": title_of(node),
            "phase": node.name if node.name in (MAIN, RECOVERY) else None,
            "kind": sign,
            "frame": getattr(node, "frame", False),
            "status": WORDS[status],
            "feedback": feedback,
            "description": _description(node) if sign == OWN else "",
            "parameters": PARAMETERS.get(sign, _own_parameters)(node),
            "since_s": since_s,
            "deadline_s": deadline_s,
            "failure": failure,
        }
    )
    for number, child in enumerate(node.children):
        _add(child, f"{path}.{number}" if path else str(number), now, found)


KINDS: dict[type, str] = {
    composites.Selector: "selector",
    composites.Sequence: "sequence",
    composites.Parallel: "parallel",
    Act: "command",
    Announce: "notice",
    Await: "await",
    Carry: "note",
    Dwell: "dwell",
    Require: "condition",
    Unless: "condition",
}
OWN = "step"  # a node of a user's own
_KIND_OF: dict[type, str] = {}


def kind(node: Behaviour) -> str:
    """The kind of a node, a word of KINDS; OWN for a node of the user's own."""
    known = _KIND_OF.get(type(node))
    if known is None:
        own = getattr(node, "sign", OWN)  # of trees from files, which say it themselves
        known = next((KINDS[base] for base in type(node).__mro__ if base in KINDS), own)
        _KIND_OF[type(node)] = known
    return known


def _description(node: Behaviour) -> str:
    """The first line of a user's node's docstring; screens describe KINDS in their own words."""
    lines = (type(node).__doc__ or "").strip().splitlines()
    return lines[0].strip() if lines else ""


def _own_parameters(node: Any) -> dict[str, Any]:
    """The parameters that a node of the user's own has, if it names any."""
    own = getattr(node, "parameters", None)
    return {str(key): str(value) for key, value in own.items()} if isinstance(own, dict) else {}


def _of_command(node: Any) -> dict[str, Any]:
    """The parameters of a command: only those that it was sent with."""
    if node.entry is None:
        return {}
    command: Command = node.entry.command
    own = {"command": command.id, **({"tries": node.tries + 1} if node.tries else {})}
    return own | command.given | own  # a kind may have values of these names


def _of_await(node: Any) -> dict[str, Any]:
    zones = {"zones": sorted(node.zones)} if isinstance(node, TakeZones) else {}
    devices = {"devices": sorted(node.devices)} if isinstance(node, TakeDevices) else {}
    return {"seconds": node.seconds, **zones, **devices}


PARAMETERS: dict[str, Callable[[Any], dict[str, Any]]] = {
    "command": _of_command,
    "await": _of_await,
    "dwell": lambda node: {"seconds": node.seconds},
    "note": lambda node: {"carried": node.robot is not None},
}


def _times(node: Behaviour, now: float) -> Times:
    if isinstance(node, Act):
        return _command_times(node, now)
    if isinstance(node, Await | Dwell):
        left = node.until - node.time.now
        return node.seconds - left, max(left, 0.0)  # nobody ticks it while its cell is being held
    return UNKNOWN


def _command_times(node: Act, now: float) -> Times:
    if node.again_at is not None:
        return None, max(node.again_at - node.time.now, 0.0)
    if node.entry is None or not node.entry.open:
        return UNKNOWN
    return now - node.entry.sent_at, node.entry.deadline - now
