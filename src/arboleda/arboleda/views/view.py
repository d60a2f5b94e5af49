"""The plant as plain data (dicts, lists, str, numbers, None) and sentences for screens; read only.

The rows have the keys of the types in `client/answers/`, which say what each is, and more.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from functools import lru_cache, partial
from typing import Any, NamedTuple

from arboleda.engine import Belief, CellRun, Entry, OperatorAct, Plant, step_of, why_held, why_waiting
from arboleda.model.advice import BY_HAND, Advice, Hand, in_words, sentence
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Question
from arboleda.model.facts import Value
from arboleda.model.messages import Check, OperatorRequest, TaskChanged, Verb
from arboleda.model.plant_model import Cell, PlantModel, Robot
from arboleda.model.sentence import BOTH, Sentence
from arboleda.model.task import Task
from arboleda.model.verbs import Scope, refusable

from . import forms, geometry, tree_view, twin_view
from .zone_rows import zone_rows

Row = tuple[str, Verb, bool]


def _rows(scope: Scope) -> tuple[Row, ...]:
    """The verbs that a scope may be shown to refuse: the word of each, and whether it was done by hand."""
    verbs = refusable(scope)
    alone = [(verb.value, verb, False) for verb in verbs]
    return (*alone, *((f"{verb.value}_by_hand", verb, True) for verb in verbs if verb in BY_HAND))


OF_ROBOTS, OF_CELLS = _rows(Scope.ROBOT), _rows(Scope.CELL)
MANUAL = "manual"
RECENT = 20  # ended tasks that a snapshot shows


class CellPart(NamedTuple):
    """The part of a view that is about one cell: its row, those of its robots, those of its open tasks."""

    cell: dict[str, Any]
    robots: list[dict[str, Any]]
    tasks: dict[str, dict[str, Any]]


PartOf = Callable[[Plant, CellRun], CellPart]


def cell_part(plant: Plant, cell: CellRun) -> CellPart:
    """The part of a cell, made anew."""
    mine = [robot.name for robot in cell.cell.robots if plant.model.cell_of[robot.name] is cell.cell]
    waiting = [cell.task, *cell.queue] if cell.task else cell.queue
    return CellPart(
        cell=_cell(plant, cell),
        robots=[_robot(plant, plant.dispatcher.beliefs[name]) for name in mine],
        tasks={task.id: _task(task, plant.now) for task in waiting},
    )


def snapshot(plant: Plant, part_of: PartOf = cell_part) -> dict[str, Any]:
    """Everything a screen shows, as of the plant's last step; positions in rad and m."""
    parts = in_parts(plant, part_of)
    while True:
        try:
            next(parts)
        except StopIteration as end:
            return dict(end.value)


def in_parts(plant: Plant, part_of: PartOf = cell_part) -> Generator[None, None, dict[str, Any]]:
    """The `snapshot`, one part after the other: the plant may be stepped between two of them.

    A cell, its robots and its open tasks are of one moment. No row is older than `at`; zones, acts and tasks
    that have ended are those of the end.
    """
    at, cells, robots = plant.now, [], []
    open_tasks: dict[str, dict[str, Any]] = {}
    for cell in plant.cells.values():
        part = part_of(plant, cell)
        cells.append(part.cell)
        robots += part.robots
        open_tasks |= part.tasks
        yield
    return {
        "plant": plant.model.name,
        "epoch": plant.epoch,
        "at": at,
        "ending": plant.intake.closed,
        "cells": cells,
        "robots": robots,
        "tasks": _tasks(plant, open_tasks),
        "zones": zone_rows(plant.zones),
        "acts": [_act(act) for act in plant.acts],
        "interference": [vars(each) for each in plant.dispatcher.interference.noticed],
        "faults": [vars(each) for each in plant.provoked.last],
        "ignored": dict(plant.dispatcher.ledger.ignored),
    }


def layout(model: PlantModel) -> dict[str, Any]:
    """The part of a view that never changes while a plant runs, from its file."""
    return {
        "plant": model.name,
        "zones": list(model.zones),
        "no_stop": [robot.name for robot in model.robots.values() if not robot.has_stop],
        "cells": [_cell_layout(cell) for cell in model.cells],
        "places": geometry.places(model),
    }


def _cell_layout(cell: Cell) -> dict[str, Any]:
    return {
        "name": cell.name,
        **_handover(cell),
        "devices": _devices(cell),
        "stations": len(cell.stations),
        "places": [place.target for place in cell.places],
        **_paths(cell),
        "recipes": forms.recipes(cell),
    }


def _handover(cell: Cell) -> dict[str, str]:
    """The two robots of a handover, which clients also find under their roles."""
    meet = (cell.handover.taker, cell.handover.giver) if cell.handover else ()
    return {role: robot.name for role, robot in cell.members if robot.name in meet}


def _paths(cell: Cell) -> dict[str, Any]:
    """The paths of a cell, and the grid of the robot that drives over them."""
    space = next((space for space in cell.spaces if space.paths), None)
    grid = space.robot.floor_grid if space else None
    if space is None or grid is None:
        return {}
    return {
        "grid": {"rows": grid.rows, "columns": grid.columns},
        "paths": {path.code: list(path.nodes) for path in space.paths},
    }


def _devices(cell: Cell) -> list[dict[str, Any]]:
    return [_device(role, robot) for role, robot in cell.roles.items()]


def _device(role: str, robot: Robot) -> dict[str, Any]:
    """The row of a device in its cell."""
    return {
        "role": role,
        "name": robot.name,
        "kind": robot.kind_name,
        "position": robot.position_key,
        "holds": robot.held_fact,
        "asked": robot.is_person,
    }


def devices_once(cells: Iterable[dict[str, Any]]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Each device of these cells, with its cell; a shared one with the first of them."""
    names: set[str] = set()
    for cell in cells:
        for device in cell["devices"]:
            if device["name"] not in names:
                names.add(device["name"])
                yield cell["name"], device


def promises(plant: Plant, text: str) -> list[dict[str, Any]]:
    """The promise of each cell that a task text names; raises TextError or QueueFull."""
    return [
        {
            "cell": each.order.cell,
            "text": each.order.text,
            "seconds": each.seconds,
            "hindrance": each.hindrance,
            "full": each.is_full,
        }
        for each in plant.prospects(text)
    ]


def task_by_id(plant: Plant, id: str) -> dict[str, Any] | None:
    """One task by its id; None if the plant does not know it."""
    known = plant.intake.tasks.get(id)
    return _task(known, plant.now) if known else None


def change(changed: TaskChanged) -> dict[str, Any]:
    """The data of one line of `/task_status`."""
    return {
        "id": changed.task,
        "text": changed.text,
        "cell": changed.cell,
        "state": changed.state.value,
        "reason": changed.reason.value if changed.reason else None,
        "sentence": changed.sentence,
        **({"choice": changed.choice} if changed.choice else {}),
        **({"unchecked": _words(changed.unchecked)} if changed.unchecked else {}),
    }


def _recent(plant: Plant) -> list[Task]:
    """The open tasks, and RECENT ended ones that were accepted last."""
    tasks = list(plant.intake.tasks.values())
    ended = [task for task in tasks if task.ended_at is not None]
    forgotten = {task.id for task in ended[:-RECENT]}
    return [task for task in tasks if task.id not in forgotten]


def _tasks(plant: Plant, open_tasks: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """The tasks in the order of their acceptance; those open when their cell was seen, as they were then.

    A task accepted since then is left out, as its cell does not show it either.
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
        **_handover(cell.cell),
        "devices": _devices(cell.cell),
        "task": _task(cell.task, now) if cell.task else None,
        "step": step_of(cell.tree),
        "progress": tree_view.progress_of(cell.tree),
        "queue": [task.id for task in cell.queue],
        "paused": cell.queue.paused,
        "waiting_for": why_waiting(cell) if cell.queue else None,
        "not_ready": _not_ready(cell, ways),
        "blocked_by": _blocked_by(plant, cell),
        "held_by": why_held(cell),
        "advice": [_advice(each) for each in ways],
        "refused": _refused(plant, cell.cell.name, OF_CELLS),
        "tree": tree_view.rows(cell.tree, now) if cell.tree else [],
        "places": _places(cell) if cell.cell.counted else [],
        "teaching": None if cell.manual.teaching is None else teaching(plant, cell),
    }


def teaching(plant: Plant, cell: CellRun) -> dict[str, Any] | None:
    """The manual mode of a cell; None if nobody teaches it."""
    if cell.manual.teaching is None:
        return None
    held = cell.manual.teaching.held
    return {
        "session": cell.manual.teaching.session,
        "teacher": cell.manual.teaching.teacher,
        "seconds": plant.now - cell.manual.teaching.since,
        "robot": None if held is None else held.robot,
        "number": None if held is None else held.number,
        "trouble": cell.manual.teaching.trouble,
    }


def _places(run: CellRun) -> list[dict[str, Any]]:
    """The places of a cell."""
    counts, stations = run.context.places.counts, run.cell.station_targets
    asked = run.context.places.asked.targets
    return [
        {
            "name": place.target,
            "parts": counts[place.target],
            "holds": place.holds,
            "device": place.device,
            "by_people": place.by_people,
            "asked": place.target in asked,
            "station": stations.index(place.target) if place.target in stations else None,
        }
        for place in run.cell.counted
    ]


def _not_ready(cell: CellRun, ways: tuple[Advice, ...]) -> Sentence | None:
    """The reason why an idle cell would start no task, and the remedy; a paused queue has its own words."""
    why = cell.not_ready
    if why is None or why == cell.queue.why_paused or not ways:
        return why
    return BOTH(first=why, second=sentence(ways))


def _blocked_by(plant: Plant, cell: CellRun) -> str | None:
    """The robot that keeps an idle cell from starting a task; None if there is none."""
    why = cell.not_ready
    for robot in cell.cell.robots if why is not None else ():
        obstacle = plant.dispatcher.obstacles.of(robot.name)
        if obstacle is not None and obstacle.sentence == why:
            return robot.name
    return None


def _advice(advice: Advice) -> dict[str, Any]:
    return {
        "do": advice.do.value,
        "hand": isinstance(advice.do, Hand),
        "scope": advice.scope,
        "by_hand": advice.by_hand,
        "arguments": dict(advice.arguments),
        "instead": advice.instead,
        "said": in_words(advice),
        "why": advice.why,
        "moves": list(advice.moves),
        "drops": list(advice.drops),
        "refusal": advice.refusal,
    }


def _refused(plant: Plant, scope: str, rows: tuple[Row, ...]) -> dict[str, Sentence]:
    """The verbs that would be refused, with the reasons; those by hand as `home_by_hand` and so on."""
    found = {}
    for name, request in _requests(scope, rows):
        if (why := plant.refusal(request)) is not None:
            found[name] = why
    return found


@lru_cache(maxsize=4096)  # the same in every view: a plant has a few hundred scopes
def _requests(scope: str, rows: tuple[Row, ...]) -> list[tuple[str, OperatorRequest]]:
    """The request that each row would be, for its refusal, which does not depend on when it is asked."""
    ask = partial(OperatorRequest, at=0.0, scope=scope)
    return [(name, ask(verb=verb, by_hand=by_hand)) for name, verb, by_hand in rows]


def standing(cell: dict[str, Any]) -> str:
    """The state of a cell in a snapshot; one that is taught is in `manual` mode, an idle one that cannot
    begin `blocked` or `paused`.
    """
    if cell.get("teaching"):  # older records have none
        return MANUAL
    if cell["state"] != CellState.IDLE or cell["not_ready"] is None:
        return str(cell["state"])
    only_paused = [each["do"] for each in cell["advice"]] == [Verb.RESUME]
    return "paused" if only_paused else "blocked"


def standing_text(cell: dict[str, Any]) -> str:
    """The word for a cell's state, and for an idle cell that cannot work: `idle, blocked`."""
    state, stands = str(cell["state"]), standing(cell)
    return state if stands == state else f"{state}, {stands}"


def waited_for(snapshot: dict[str, Any]) -> dict[str, list[str]]:
    """The cells of a snapshot that wait for people: whom they wait for, by name."""
    asking = {robot["name"]: robot["holder"] for robot in snapshot["robots"] if robot["question"] is not None}
    cells = {cell["name"]: [device["name"] for device in cell["devices"]] for cell in snapshot["cells"]}
    waits = {
        cell: [name for name in names if name in asking and asking[name] in (None, cell)]
        for cell, names in cells.items()
    }
    return {cell: names for cell, names in waits.items() if names}


def elapsed_s(task: Task, now: float) -> float | None:
    """The time that a task takes or took; None before its begin."""
    if task.started_at is None:
        return None
    return (task.ended_at if task.ended_at is not None else now) - task.started_at


def _task(task: Task, now: float) -> dict[str, Any]:
    return {
        "id": task.id,
        "text": task.order.text,
        "cell": task.order.cell,
        "state": task.state.value,
        "reason": task.failure.reason.value if task.failure else None,
        "sentence": task.remark,
        "failed_in": task.failed_in,
        "elapsed_s": elapsed_s(task, now),
        "started_at": task.started_at,
        "ended_at": task.ended_at,
        "answers": [dict(vars(each)) for each in task.answers],
        "choice": task.choice,
        "unchecked": _words(task.unchecked),
    }


def _words(checks: Iterable[Check]) -> list[str]:
    return [each.value for each in checks]


def _robot(plant: Plant, belief: Belief) -> dict[str, Any]:
    robot, now = belief.robot, plant.now
    dispatcher = plant.dispatcher
    obstacle, last = dispatcher.obstacles.of(robot.name), dispatcher.ledger.last_sent.get(robot.name)
    return {
        "name": robot.name,
        "kind": robot.kind_name,
        "holder": plant.zones.holder(robot.name) if robot.name in plant.model.shared else None,
        "mqtt": robot.mqtt,
        "online": belief.online,
        "obstacle": obstacle.sentence if obstacle else None,
        "state": belief.state.value if belief.state is not None else None,
        "age_s": None if belief.heard_at is None else now - belief.heard_at,
        "q": belief.q,
        "units": robot.units,
        "node": belief.node,
        "homed": belief.homed,
        "latched": robot.name in plant.dispatcher.latches.stopped,
        "effector": belief.effector,
        "piece": belief.piece,
        "facts": _facts(belief),
        "answer": last.answer if last is not None else None,
        "question": _question(plant.dispatcher.ledger.question(robot.name), now),
        "boot_id": belief.boot_id,
        "bridge_epoch": belief.epoch,
        "still": belief.stillness.is_still,
        "holding": plant.dispatcher.effectors.grips.holding(robot.name) if robot.held_fact else None,
        "goal": twin_view.goal(last),
        "telemetry_hz": belief.rate.hz if belief.online else None,
        "command": _command(last, now),
        "rejected": _rejected(plant.dispatcher.booking.rejected.get(robot.name)),
        "refused": _refused(plant, robot.name, OF_ROBOTS),
    }


def _question(entry: Entry | None, now: float) -> dict[str, Any] | None:
    """The open question to a person, its answers, and the seconds left; None if there is none."""
    if entry is None or not isinstance(entry.command, Question):
        return None
    question = entry.command
    return {
        "id": question.id,
        "text": question.text,
        "answers": list(question.answers),
        "left_s": left_s(entry, now),
    }


def left_s(entry: Entry, now: float) -> float:
    """The time left until a command is given up."""
    return max(entry.deadline - now, 0.0)


def _facts(belief: Belief) -> dict[str, Value | None]:
    """The facts of a device, None for those not reported: those of its kind, a held part, and any others."""
    robot = belief.robot
    found = {name: belief.fact(name) for name in robot.fact_names}
    if robot.held_fact is not None:
        found.setdefault(robot.held_fact, belief.fact(robot.held_fact))
    if belief.piece is not None:
        found.setdefault("piece", belief.piece)
    return found


def _command(entry: Entry | None, now: float) -> dict[str, Any] | None:
    """The last command of a robot."""
    if entry is None:
        return None
    id, what = entry.command.id, entry.doing
    return {"id": id, "what": what, "state": entry.state.value, "age_s": now - entry.sent_at}


def _rejected(known: tuple[int, Sentence | None] | None) -> dict[str, Any]:
    """The number of commands that a robot refused, and the reason of the last one."""
    count, last = known or (0, None)
    return {"count": count, "last": last}


def _act(act: OperatorAct) -> dict[str, Any]:
    """An operator's act and its outcome."""
    return {
        "number": act.number,
        "at": act.at,
        "scope": act.scope,
        "cell": act.cell,
        "sentence": act.sentence,
        "verb": act.verb.value,
        "outcome": act.outcome.value,
        "why": act.why,
        "ended_at": act.ended_at,
        "ended": None if act.ended_at is None else act.ended,
    }


def act_by_number(plant: Plant, number: int) -> dict[str, Any] | None:
    """One of the operators' last acts; None if the plant has forgotten it."""
    return next((_act(act) for act in plant.acts if act.number == number), None)
