"""Appearance of a plant, as plain data: positions of robots and parts, and the goals of motions."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.engine import OPEN, Act, Belief, CellRun, Entry, Plant, State
from arboleda.model.commands import Motion, Position, Switch
from arboleda.model.grips import Grip
from arboleda.model.plant_model import Cell
from arboleda.model.tree_nodes import nodes_of

from .zone_rows import zone_rows

Row = dict[str, Any]
UNDER_WAY = frozenset({State.SENT, State.RUNNING})


def positions(plant: Plant) -> Row:
    """All values that a drawing of the plant depends on, as of the last step; rad, m, s (plant's clock)."""
    parts = in_parts(plant)
    while True:
        try:
            next(parts)
        except StopIteration as end:
            return dict(end.value)


def in_parts(plant: Plant) -> Generator[None, None, Row]:
    """The `positions`, one part after the other: the plant may be stepped between two of them."""
    robots, parts, books = [], {}, {}
    for belief in plant.dispatcher.beliefs.values():
        robots.append(_robot(plant, belief))
        yield
    for name, cell in plant.cells.items():
        parts[name], books[name] = part(cell), at_places(cell)
        yield
    return {"robots": robots, "parts": parts, "books": books, "zones": zone_rows(plant.zones)}


def goal(entry: Entry | None) -> Row | None:
    """The goal of a robot's open motion command: {"q"} or {"nodes"}; None if there is none."""
    way = _way(entry) if entry is not None and entry.state in UNDER_WAY else ()
    if not way:
        return None
    end = way[-1]
    return {"q": list(end)} if isinstance(end, tuple) else {"nodes": list(way)}


def part(run: CellRun) -> Row | None:
    """The place of the part that a cell works on: {"at": "arm", "sure"}, {"at": "mobile"} or {"at": "pose",
    "q"}.

    Only what an effector holds is known by itself; where a part waits, and where it was put, follows from
    what the tree has done so far. None where nobody draws the work of such a cell, or where the books say who
    carries a part.
    """
    cell = run.cell
    if cell.handover is None or cell.places:
        return None
    for holder in cell.holders:
        grip = run.context.parts.grip(holder)
        if grip is not Grip.OFF:
            return {"at": "arm", "sure": grip is Grip.ON}
    if run.tree is None or run.task is None:
        return None
    sent = _sent(run.tree)
    gripped = [entry for entry in sent if _grips(entry) is not None]
    if gripped:
        return _put_down(sent, gripped[-1], cell)
    group = cell.recipe(run.task.order.recipe).part_from
    if group is None:
        return {"at": "mobile"}
    pose = cell.reach[cell.handover.taker].targets[cell.groups[group][0]]
    return {"at": "pose", "q": list(pose.joints)}


def at_places(run: CellRun) -> Row:
    """The parts of a cell by its books: how many at each place, and the robots that carry one, which may be
    sure.
    """
    places = run.context.places
    follows = run.cell.handover is not None and not run.cell.places  # as `part` does
    return {"places": places.counts, "carriers": {} if follows else places.carriers}


def _put_down(sent: list[Entry], let_go: Entry, cell: Cell) -> Row | None:
    """The pose at which the arm let go of the part; None if it lies in a station: the books have it."""
    before = [_way(entry)[-1] for entry in sent[: sent.index(let_go)] if _way(entry)]
    places = [place for place in before if isinstance(place, tuple)]
    if not places or any(places[-1] == station.q for station in cell.stations):
        return None
    return {"at": "pose", "q": list(places[-1])}


def _way(entry: Entry) -> tuple[Position, ...]:
    return entry.command.way if isinstance(entry.command, Motion) else ()


def _grips(entry: Entry) -> bool | None:
    return entry.command.grips if isinstance(entry.command, Switch) else None


def _sent(tree: Behaviour) -> list[Entry]:
    """The commands that a tree has given, in order."""
    entries = [node.entry for node in nodes_of(tree) if isinstance(node, Act) and node.entry is not None]
    return sorted(entries, key=lambda entry: entry.sent_at)


def _robot(plant: Plant, belief: Belief) -> Row:
    name = belief.robot.name
    last = plant.dispatcher.ledger.last_sent.get(name)
    return {
        "name": name,
        "q": belief.q,
        "node": belief.node,
        "position_at": belief.stillness.position_at if belief.position is not None else None,
        "heard_at": belief.heard_at,
        "online": belief.online,
        "homed": not belief.unhomed,
        "reports": belief.supervised or _positioned(plant, belief),
        "goal": goal(last),
        "going_since": last.accepted_at if last is not None and last.state in OPEN else None,
        "reached": _reached(plant, belief, last),
    }


def _positioned(plant: Plant, belief: Belief) -> bool:
    """True if a robot that need not report its position has done so lately."""
    known = belief.position is not None
    return known and plant.now - belief.stillness.position_at <= plant.model.timing.stale_after_s


def _reached(plant: Plant, belief: Belief, last: Entry | None) -> Row | None:
    """The proven end of a robot's last motion: {"q"} or {"node"}; None if there is none."""
    place = plant.dispatcher.whereabouts.reached.get(belief.robot.name)
    if isinstance(place, tuple):
        return {"q": list(place)}
    way = _way(last) if last is not None and last.state is State.DONE else ()
    return {"node": way[-1]} if way and isinstance(way[-1], int) else None
