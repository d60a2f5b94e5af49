"""The plant as plain data (dicts, lists, str, numbers, None) and sentences for screens; read only."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.core import steps
from arboleda.core.advice import Advice, Hand, in_words, sentence
from arboleda.core.belief import Belief
from arboleda.core.cell import CellRun
from arboleda.core.cell_states import CellState
from arboleda.core.leaves import title_of
from arboleda.core.ledger import Entry
from arboleda.core.messages import OperatorRequest, TaskChanged, Verb
from arboleda.core.model import PlantModel
from arboleda.core.operator import OperatorAct
from arboleda.core.plant import Plant
from arboleda.core.sentence import BOTH, NOTHING, Phrase, Sentence
from arboleda.core.task import Task
from arboleda.recipes.storage_cell import StorageCell
from arboleda.wire.status import ERROR, OK, STALE, WARN

from . import places, tree_view, twin_view

IN_RECOVERY = Phrase("step.in_recovery", "recovery: {step}")
Diagnostic = tuple[str, str, int, str, dict[str, str]]
TIMES = frozenset({"age_s", "telemetry_hz"})  # a diagnosis changes with the robot, not with time
OF_ROBOTS = (Verb.CLEAR, Verb.RELEASE, Verb.HOME)
OF_CELLS = (
    *OF_ROBOTS,
    Verb.RESET,
    Verb.HOLD,
    Verb.RESUME,
    Verb.CANCEL,
    Verb.RETRY,
    Verb.ABANDON,
    Verb.UNLOAD,
)
RECENT = 20  # ended tasks that a snapshot shows


def snapshot(plant: Plant) -> dict[str, Any]:
    """Everything a screen shows, as of the plant's last step; positions in rad and m."""
    parts = in_parts(plant)
    while True:
        try:
            next(parts)
        except StopIteration as end:
            return dict(end.value)


def in_parts(plant: Plant) -> Generator[None, None, dict[str, Any]]:
    """The `snapshot`, one part after the other: the plant may be stepped between two of them.

    A cell, its robots and its open tasks are of one moment. No row is older than `at`; zones, acts and tasks
    that have ended are those of the end.
    """
    at, cells, robots = plant.now, [], []
    open_tasks: dict[str, dict[str, Any]] = {}
    for cell in plant.cells.values():
        cells.append(_cell(plant, cell))
        robots += [_robot(plant, plant.dispatcher.beliefs[robot.name]) for robot in cell.cell.robots]
        waiting = [cell.task, *cell.queue] if cell.task else cell.queue
        open_tasks |= {task.id: _task(task, plant.now) for task in waiting}
        yield
    return {
        "plant": plant.model.name,
        "epoch": plant.epoch,
        "at": at,
        "ending": plant.intake.closed,
        "cells": cells,
        "robots": robots,
        "tasks": _tasks(plant, open_tasks),
        "zones": plant.zones.snapshot(),
        "acts": [_act(act) for act in plant.acts],
        "interference": [vars(each) for each in plant.dispatcher.interference.noticed],
        "ignored": dict(plant.dispatcher.ledger.ignored),
    }


def layout(model: PlantModel) -> dict[str, Any]:
    """What never changes while a plant runs, as its file says it."""
    return {
        "plant": model.name,
        "zones": list(model.zones),
        "no_stop": [robot.name for robot in model.robots.values() if not robot.has_stop],
        "cells": [_cell_layout(cell) for cell in model.cells if isinstance(cell, StorageCell)],
        "places": places.places(model),
    }


def _cell_layout(cell: StorageCell) -> dict[str, Any]:
    grid = cell.mobile.grid
    return {
        "name": cell.name,
        "arm": cell.arm.name,
        "mobile": cell.mobile.name,
        "grid": {"rows": grid.rows, "columns": grid.columns},
        "paths": {path.code: list(path.nodes) for path in cell.paths},
        "stations": len(cell.stations),
    }


def task_by_id(plant: Plant, id: str) -> dict[str, Any] | None:
    """One task by its id, None where the plant knows none."""
    known = plant.intake.tasks.get(id)
    return _task(known, plant.now) if known else None


def change(changed: TaskChanged) -> dict[str, Any]:
    """One line of `/task_status`."""
    return {
        "id": changed.task,
        "text": changed.text,
        "cell": changed.cell,
        "state": changed.state.value,
        "reason": changed.reason.value if changed.reason else None,
        "sentence": changed.sentence,
    }


def step_of(tree: Behaviour | None) -> Sentence | None:
    """The name of the step that runs, a step's own parts left out; a recovery's steps say so."""
    running = [node for node in tree.iterate() if node.status is Status.RUNNING] if tree else []
    if not running:
        return None
    step = running[0]
    while step.parent is not None and step.parent.name not in steps.PHASES:
        step = step.parent
    phase = step.parent.name if step.parent else ""
    title = title_of(step)
    return IN_RECOVERY(step=title) if phase == steps.RECOVERY else title


def progress_of(tree: Behaviour | None) -> float | None:
    """The share of the work's steps that are done, 0 to 1; None where no work runs, a recovery alone too."""
    phases = tree.children if tree is not None else ()
    main = next((phase for phase in phases if phase.name == steps.MAIN), None)
    if main is None or not main.children:
        return None
    return sum(step.status is Status.SUCCESS for step in main.children) / len(main.children)


def _recent(plant: Plant) -> list[Task]:
    """Every open task, and the RECENT ones that ended last to be accepted."""
    tasks = list(plant.intake.tasks.values())
    ended = [task for task in tasks if task.ended_at is not None]
    forgotten = {task.id for task in ended[:-RECENT]}
    return [task for task in tasks if task.id not in forgotten]


def _tasks(plant: Plant, open_tasks: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """In the order of their acceptance, those as they were that were open when their cell was seen.

    One that was accepted since then is left out, as its cell does not show it either.
    """
    ended = {task.id: _task(task, plant.now) for task in _recent(plant) if task.ended_at is not None}
    rows = ended | open_tasks
    forgotten = [row for id, row in rows.items() if id not in plant.intake.tasks]
    return forgotten + [rows[id] for id in plant.intake.tasks if id in rows]


def _cell(plant: Plant, cell: CellRun) -> dict[str, Any]:
    now, ways = plant.now, plant.advice(cell.cell.name)
    return {
        "name": cell.cell.name,
        "state": cell.state.value,
        **{role: robot.name for role, robot in cell.cell.roles.items()},
        "task": _task(cell.task, now) if cell.task else None,
        "step": step_of(cell.tree),
        "progress": progress_of(cell.tree),
        "queue": [task.id for task in cell.queue],
        "paused": cell.queue_paused,
        "waiting_for": cell.waiting_for() if cell.queue else None,
        "not_ready": _not_ready(cell, ways),
        "blocked_by": _blocked_by(plant, cell),
        "held_by": cell.held_by,
        "advice": [_advice(each) for each in ways],
        "refused": _refused(plant, cell.cell.name, OF_CELLS),
        "tree": tree_view.rows(cell.tree, now) if cell.tree else [],
    }


def _not_ready(cell: CellRun, ways: tuple[Advice, ...]) -> Sentence | None:
    """Why an idle cell would start no task, and what to do; a queue that is paused says so itself."""
    why = cell.not_ready
    if why is None or why == cell.why_paused or not ways:
        return why
    return BOTH(first=why, second=sentence(ways))


def _blocked_by(plant: Plant, cell: CellRun) -> str | None:
    """The robot whose obstacle is why an idle cell would start no task."""
    why = cell.not_ready
    for robot in cell.cell.robots if why is not None else ():
        obstacle = plant.dispatcher.obstacle(robot.name)
        if obstacle is not None and obstacle.sentence == why:
            return robot.name
    return None


def _advice(advice: Advice) -> dict[str, Any]:
    return {
        "do": advice.do.value,
        "hand": isinstance(advice.do, Hand),
        "scope": advice.scope,
        "by_hand": advice.by_hand,
        "instead": advice.instead,
        "said": in_words(advice),
        "why": advice.why,
        "moves": list(advice.moves),
        "drops": list(advice.drops),
        "refusal": advice.refusal,
    }


def _refused(plant: Plant, scope: str, verbs: tuple[Verb, ...]) -> dict[str, Sentence]:
    """The verbs that would be refused there now, and why; homing by hand is `home_by_hand`."""
    asked = {verb.value: OperatorRequest(at=plant.now, verb=verb, scope=scope) for verb in verbs}
    if Verb.HOME in verbs:
        by_hand = OperatorRequest(at=plant.now, verb=Verb.HOME, scope=scope, by_hand=True)
        asked["home_by_hand"] = by_hand
    found = {name: plant.refusal(request) for name, request in asked.items()}
    return {name: why for name, why in found.items() if why is not None}


def standing(cell: dict[str, Any]) -> str:
    """How a cell of a snapshot stands: its state; where it only looks idle, `blocked` or `paused`."""
    if cell["state"] != CellState.IDLE or cell["not_ready"] is None:
        return str(cell["state"])
    only_paused = [each["do"] for each in cell["advice"]] == [Verb.RESUME]
    return "paused" if only_paused else "blocked"


def standing_said(cell: dict[str, Any]) -> str:
    """The word of a cell's state, and behind it why one that is idle cannot work: `idle, blocked`."""
    state, stands = str(cell["state"]), standing(cell)
    return state if stands == state else f"{state}, {stands}"


def _task(task: Task, now: float) -> dict[str, Any]:
    started = task.started_at
    ended = task.ended_at if task.ended_at is not None else now
    return {
        "id": task.id,
        "text": task.order.text,
        "cell": task.order.cell,
        "state": task.state.value,
        "reason": task.failure.reason.value if task.failure else None,
        "sentence": task.failure.sentence if task.failure else NOTHING,
        "failed_in": task.failed_in,
        "elapsed_s": None if started is None else ended - started,
        "started_at": started,
        "ended_at": task.ended_at,
    }


def _robot(plant: Plant, belief: Belief) -> dict[str, Any]:
    robot, now = belief.robot, plant.now
    obstacle = plant.dispatcher.obstacle(robot.name)
    return {
        "name": robot.name,
        "mqtt": robot.mqtt,
        "online": belief.online,
        "obstacle": obstacle.sentence if obstacle else None,
        "state": belief.state.value if belief.state is not None else None,
        "age_s": None if belief.heard_at is None else now - belief.heard_at,
        "q": belief.q,
        "units": robot.units,
        "node": belief.node,
        "homed": belief.homed,
        "latched": robot.name in plant.dispatcher.latched,
        "effector": belief.effector,
        "piece": belief.piece,
        "boot_id": belief.boot_id,
        "bridge_epoch": belief.epoch,
        "still": belief.still,
        "holding": plant.dispatcher.grips.holding(robot.name) if robot.held_fact else None,
        "goal": twin_view.goal(plant.dispatcher.last_sent.get(robot.name)),
        "telemetry_hz": belief.rate_hz if belief.online else None,
        "command": _command(plant.dispatcher.last_sent.get(robot.name), now),
        "rejected": _rejected(plant.dispatcher.rejected.get(robot.name)),
        "refused": _refused(plant, robot.name, OF_ROBOTS),
    }


def _command(entry: Entry | None, now: float) -> dict[str, Any] | None:
    """The last command of a robot."""
    if entry is None:
        return None
    id, what = entry.command.id, entry.doing
    return {"id": id, "what": what, "state": entry.state.value, "age_s": now - entry.sent_at}


def _rejected(known: tuple[int, Sentence | None] | None) -> dict[str, Any]:
    """How many commands a robot refused, and why the last one."""
    count, last = known or (0, None)
    return {"count": count, "last": last}


def _act(act: OperatorAct) -> dict[str, Any]:
    """What an operator did; `number` grows by one with every act."""
    return {
        "number": act.number,
        "at": act.at,
        "scope": act.scope,
        "cell": act.cell,
        "sentence": act.sentence,
    }


def diagnostics(snapshot: dict[str, Any]) -> Iterator[Diagnostic]:
    """One (name, hardware id, level, message, values) per robot and cell of a snapshot."""
    yield from map(_robot_diagnostic, snapshot["robots"])
    yield from map(_cell_diagnostic, snapshot["cells"])


def _robot_diagnostic(robot: dict[str, Any]) -> Diagnostic:
    level = OK if robot["online"] else STALE
    if robot["online"] and robot["state"] not in (None, 0, 1):
        level = ERROR
    plain = {key: value for key, value in robot.items() if not isinstance(value, dict) and key not in TIMES}
    values = {key: str(value) for key, value in plain.items() if value is not None}
    if robot["telemetry_hz"] is not None:
        values["telemetry_hz"] = f"{robot['telemetry_hz']:.0f}"
    return (f"arboleda: {robot['name']}", robot["mqtt"], level, str(robot["obstacle"] or "ready"), values)


def _cell_diagnostic(cell: dict[str, Any]) -> Diagnostic:
    well = (
        cell["state"] in (CellState.IDLE, CellState.EXECUTE) and not cell["paused"] and not cell["not_ready"]
    )
    message = str(cell["held_by"] or cell["not_ready"] or cell["waiting_for"] or cell["state"])
    values = {
        "state": cell["state"],
        "queued": str(len(cell["queue"])),
        "step": str(cell["step"] or ""),
        "waiting_for": str(cell["not_ready"] or cell["waiting_for"] or ""),
        "advice": ", ".join(str(each["said"]) for each in cell["advice"]),
    }
    level = OK if well else WARN
    return (f"arboleda: {cell['name']}", "", level, message, values)
