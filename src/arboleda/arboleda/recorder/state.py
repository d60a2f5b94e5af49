"""State of a plant that is compared after each step: all of one cell, the cells in turns."""

from __future__ import annotations

from operator import attrgetter
from typing import Any

from arboleda.engine import Belief, CellRun, Entry, Plant, Teaching

# Times that follow from when a report came are left out: they say nothing new, and are hard to compress.
BELIEVED = (
    "heard_at",
    "stale",
    "online",
    "epoch",
    "plant",
    "boot_id",
    "state",
    "q",
    "node",
    "reports",
    "rate.hz",
    "piece",
    "homed",
    "effector",
    "displaced",
    "barred",
    "receipt",
    "facts_no",
    "lost",
)
OPENED = ("command", "state", "sent_at", "deadline", "settles_at", "accepted_at", "cancelled_at", "answer")
STANDS = (
    "state",
    "queue.paused",
    "queue.left_over",
    "dirty",
    "closed",
    "trouble",
    "awaits",
    "stranded",
    "due",
)
_believed, _opened, _stands = attrgetter(*BELIEVED), attrgetter(*OPENED), attrgetter(*STANDS)

State = dict[str, Any]


def state_of(plant: Plant, turn: int) -> State:
    """The plant's own counters, and the whole state of the cell whose turn it is, as unchanging values."""
    names = tuple(plant.cells)
    run = plant.cells[names[turn % len(names)]]
    return {"version": plant.version, "next_deadline": plant.next_deadline, **_cell(plant, run)}


def _cell(plant: Plant, run: CellRun) -> State:
    task = run.task
    robots = run.cell.robots
    return {
        "cell": run.cell.name,
        "stands": _stands(run),
        "queue": tuple([each.id for each in run.queue]),
        "task": None if task is None else (task.id, task.state, task.attempts, task.failure),
        "tree": tuple([node.status for node in run.run.nodes]),
        "commands": tuple([_opened(entry) for entry in _entries(plant, run)]),
        "devices": {robot.name: _device(plant.dispatcher.beliefs[robot.name]) for robot in robots},
        "latched": tuple([robot.name for robot in robots if robot.name in plant.dispatcher.latches.stopped]),
        **_taught(run.manual.teaching),
        "holds": tuple([(robot.name, zone) for robot in robots for zone in _zones(plant, robot.name)]),
    }


def _taught(teaching: Teaching | None) -> State:
    """The manual mode of a cell, while there is one; records of before it know of none."""
    if teaching is None:
        return {}
    return {"taught": (teaching.session, teaching.teacher, teaching.held, teaching.due, teaching.trouble)}


def _entries(plant: Plant, run: CellRun) -> list[Entry]:
    return plant.dispatcher.ledger.of_cell(run.cell.name)


def _device(belief: Belief) -> tuple[Any, ...]:
    return (*_believed(belief), tuple(belief.facts.items()))


def _zones(plant: Plant, robot: str) -> list[str]:
    return sorted(plant.zones.held_by(robot)) if plant.zones.is_used else []


def named(state: Any) -> dict[str, Any]:
    """The state as plain data, with a name for each value, which reports of differences use."""
    rows = dict(state)
    rows["stands"] = dict(zip(STANDS, state["stands"], strict=True))
    rows["commands"] = [dict(zip(OPENED, each, strict=True)) for each in state["commands"]]
    rows["devices"] = {
        name: dict(zip((*BELIEVED, "facts"), each, strict=True)) for name, each in state["devices"].items()
    }
    return rows
