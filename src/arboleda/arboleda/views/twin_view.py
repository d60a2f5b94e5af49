"""What a plant looks like from outside, as plain data: where robots and parts are, and where they go."""

from __future__ import annotations

from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.core.belief import Belief
from arboleda.core.cell import CellRun
from arboleda.core.grips import Grip
from arboleda.core.leaves import Act
from arboleda.core.ledger import OPEN, Entry, State
from arboleda.core.plant import Plant
from arboleda.kinds.arm import MoveJoints, SetEffector
from arboleda.kinds.mobile import FollowPath
from arboleda.recipes.storage_cell import StorageCell

Row = dict[str, Any]
UNDER_WAY = frozenset({State.SENT, State.RUNNING})


def positions(plant: Plant) -> Row:
    """All that may change what is drawn, as of the last step; rad, m, s of the plant's clock."""
    return {
        "robots": [_robot(plant, belief) for belief in plant.dispatcher.beliefs.values()],
        "parts": {name: part(cell) for name, cell in plant.cells.items()},
        "stored": {name: sorted(cell.context.stored) for name, cell in plant.cells.items()},
        "zones": plant.zones.snapshot(),
    }


def goal(entry: Entry | None) -> Row | None:
    """Where a robot's open motion command leads: {"q"} or {"nodes"}."""
    if entry is None or entry.state not in UNDER_WAY:
        return None
    command = entry.command
    if isinstance(command, MoveJoints):
        return {"q": list(command.q)}
    return {"nodes": list(command.nodes)} if isinstance(command, FollowPath) else None


def part(cell: CellRun) -> Row | None:
    """Where the part of the cell's work is: {"at": "arm", "sure"}, {"at": "mobile"} or {"at": "pose", "q"}.

    Only what an effector holds is known by itself; where a part waits, and where it was put, follows from
    what the tree has done so far.
    """
    storage = cell.cell
    if not isinstance(storage, StorageCell):
        return None
    grip = cell.context.grip(storage.arm.name)
    if grip is not Grip.OFF:
        return {"at": "arm", "sure": grip is Grip.ON}
    if cell.tree is None or cell.task is None:
        return None
    sent = _sent(cell.tree)
    gripped = [entry for entry in sent if isinstance(entry.command, SetEffector)]
    if gripped:
        return _put_down(sent, gripped[-1], storage)
    return _waiting(cell.task.order.recipe, storage)


def _waiting(recipe: str, cell: StorageCell) -> Row:
    if recipe == "storage":
        return {"at": "mobile"}
    return {"at": "pose", "q": list(cell.palletizing.pick.joints)}


def _put_down(sent: list[Entry], let_go: Entry, cell: StorageCell) -> Row | None:
    """Where the arm was sent to last before it let go; what lies in a station is `stored`."""
    before = sent[: sent.index(let_go)]
    moves = [entry.command for entry in before if isinstance(entry.command, MoveJoints)]
    if not moves or any(moves[-1].q == station.q for station in cell.stations):
        return None
    return {"at": "pose", "q": list(moves[-1].q)}


def _sent(tree: Behaviour) -> list[Entry]:
    """The commands that a tree gave, in their order."""
    entries = [node.entry for node in tree.iterate() if isinstance(node, Act) and node.entry is not None]
    return sorted(entries, key=lambda entry: entry.sent_at)


def _robot(plant: Plant, belief: Belief) -> Row:
    name = belief.robot.name
    last = plant.dispatcher.last_sent.get(name)
    return {
        "name": name,
        "q": belief.q,
        "node": belief.node,
        "position_at": belief.position_at if belief.position is not None else None,
        "heard_at": belief.heard_at,
        "online": belief.online,
        "homed": not belief.unhomed,
        "reports": belief.supervised or _positioned(plant, belief),
        "goal": goal(last),
        "going_since": last.accepted_at if last is not None and last.state in OPEN else None,
        "reached": _reached(plant, belief, last),
    }


def _positioned(plant: Plant, belief: Belief) -> bool:
    """Whether a robot that need not say where it is has said so lately."""
    known = belief.position is not None
    return known and plant.now - belief.position_at <= plant.model.timing.stale_after_s


def _reached(plant: Plant, belief: Belief, last: Entry | None) -> Row | None:
    """Where its last motion ended, as far as that was proven: {"q"} or {"node"}."""
    place = plant.dispatcher.reached.get(belief.robot.name)
    if isinstance(place, tuple):
        return {"q": list(place)}
    if last is None or last.state is not State.DONE or not isinstance(last.command, FollowPath):
        return None
    return {"node": last.command.nodes[-1]}
