"""Invariants of screens, drawings and ROS 2: they show the plant as it is by the record."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.drivers import Arm, Evidence, FollowPath, Mobile, MoveJoints, PayloadError, Robot
from arboleda.engine import OPEN, State
from arboleda.engine.inspection import reached_of
from arboleda.model.cell_states import CellState
from arboleda.model.messages import OperatorRequest
from arboleda.model.sentence import OWN
from arboleda.model.tree_nodes import nodes_of
from arboleda.model.verbs import Scope, refusable
from arboleda.views import diagnostics, geometry, twin_view, view
from arboleda.wire import status

from ..recorded.cells import KnownCell
from ..recorded.commands import SentCommand
from ..recorded.robots import KnownRobot, StopProgress
from ..recorded.time_line import UNIX_S
from . import rows
from .invariant import Look, Trigger, invariant
from .liveness import ready

NOTHING: tuple[str, ...] = ()
EVERY_S, STATUS_S, GARBLED_S = 5.0, 1.0, 10.0
EXACT = 1e-6
AT_FIRST = ("idle", "free", "offline")  # of which there is no event where a thing begins so
GOING = (State.SENT, State.RUNNING)
STALE, ERROR, WARN, OK = 3, 2, 1, 0
STATUSES = {status: status.value for status in Status}
Row = dict[str, Any]


@invariant(Trigger.TOLD, every_s=EVERY_S)
def screens_show_what_is(look: Look) -> Iterable[str]:
    """A screen shows cells, tasks, robots and zones as they were told, asked and commanded."""
    if look.whole:
        return _shown(look) if _only_arms_and_mobiles(look) else NOTHING
    return _lines(look) if look.record.tasks.changes else NOTHING


def _only_arms_and_mobiles(look: Look) -> bool:
    """True if each cell is one of an arm and a mobile robot: rows of other devices are not written here."""
    cells = look.world.model.cells
    kinds = [[(role, robot.kind_name) for role, robot in cell.members] for cell in cells if cell.handover]
    return kinds == [[("arm", "arm"), ("mobile", "mobile")]] * len(cells)


def _is_own(look: Look, cell: KnownCell) -> bool:
    """True if a cell is at a task of a recipe that does not come with Arboleda."""
    task = cell.run.task
    shipped = {each.name for each in cell.cell.recipes if each.is_shipped}
    return bool(look.world.recipes) or (task is not None and task.order.recipe not in shipped)


def _lines(look: Look) -> Iterator[str]:
    for change in look.record.tasks.changes:
        yield from _unlike(
            f"task {change.message.task}", view.change(change.message), rows.line(change.message)
        )


def _shown(look: Look) -> Iterator[str]:
    plant, record = look.world.plant, look.record
    shown = view.snapshot(plant)
    yield from _unlike("the plant", shown, _plant(look))
    for row in shown["cells"]:
        cell = record.cells[row["name"]]
        yield from _unlike(cell.name, row, _cell(look, cell))
        if cell.state is CellState.IDLE and cell.paused and row["not_ready"] is None:
            yield f"{cell.name} is shown as ready, and its queue is paused"
        yield from rows.queue(cell, row, own=_is_own(look, cell))
        yield from _refused(look, row, "cell")
        yield from rows.ways(plant.advice(cell.name), row)
        if view.standing_text(row) != rows.stands(row):
            yield f"{cell.name} is said to be {view.standing_text(row)}, it is {rows.stands(row)}"
        yield from _tree(cell, row["tree"], record.step.at, own=_is_own(look, cell))
    for row in shown["robots"]:
        known = record.robots[row["name"]]
        yield from _unlike(known.robot.name, row, _robot(look, known))
        yield from _obstacle(look, known, row)
        yield from _refused(look, row, "robot")
        yield from rows.rejected(record.commands.last.get(row["name"]), row)
    yield from _tasks(look, shown)
    open_tasks = {row["id"]: row["state"] for row in shown["tasks"] if row["ended_at"] is None}
    if open_tasks != {id: task.state.value for id, task in record.tasks.open.items()}:
        yield f"tasks {open_tasks} are shown as open"
    yield from _diagnoses(shown)
    yield from _drawn(look, twin_view.positions(plant))
    yield from _time_line(look, shown)


# what is shown of a cell or a robot that verbs may be refused for, and of what only whether there is any
REFUSED_BY = ("state", "paused", "online", "homed", "latched", "effector", "piece", "holding", "node")
REFUSED_BY_ANY = (
    "task",
    "queue",
    "tree",
    "held_by",
    "not_ready",
    "blocked_by",
    "teaching",
    "obstacle",
    "question",
)
REFUSABLE = {kind: refusable(Scope(kind)) for kind in ("cell", "robot")}


def _refused(look: Look, row: Row, kind: str) -> Iterator[str]:
    """Differences between the verbs shown as refused for a cell or a robot and those refused now, which are
    asked for where these or what they may depend on have changed.
    """
    plant, found = look.world.plant, []
    shown = [name for name in row["refused"] if not name.endswith("_by_hand")]
    stands = *map(row.get, REFUSED_BY), *map(bool, map(row.get, REFUSED_BY_ANY))
    if not look.record.checked.is_new(f"refused {row['name']}", (plant.epoch, *shown, *stands)):
        return
    for verb in REFUSABLE[kind]:
        if plant.refusal(OperatorRequest(at=plant.now, verb=verb, scope=row["name"])) is not None:
            found.append(verb.value)
    if sorted(shown) != sorted(found):
        yield f"{row['name']}: {shown} are shown as refused, {found} would be"


def _time_line(look: Look, shown: Row) -> Iterator[str]:
    """Differences between time line and record: each thing's last event, and an event for each act."""
    line = look.record.time_line
    line.see(shown)
    if line.received != shown:
        yield "who hears only what is new of the plant knows something else than who is shown all of it"
    if not line.whole:
        return
    now = {("cell", row["name"]): row["state"] for row in shown["cells"]}
    now |= {("robot", row["name"]): "online" if row["online"] else "offline" for row in shown["robots"]}
    now |= {("zone", row["zone"]): row["state"] for row in shown["zones"]}
    now |= {("task", row["id"]): row["state"] for row in shown["tasks"]}
    for (kind, subject), state in now.items():
        event = line.last.get((kind, subject))
        known = event["what"] if event is not None else None
        if known != state and not (event is None and state in AT_FIRST):
            yield f"the last event of {kind} {subject} is {known}, it is {state}"
    for act in shown["acts"]:
        then = (each for each in line.acts if abs(each["at"] - UNIX_S - act["at"]) <= EXACT)
        if not any(each["sentence"] == act["sentence"] for each in then):
            times = [each["at"] for each in line.acts if each["sentence"] == act["sentence"]]
            yield f"there is no event of {act['sentence']!r} at {act['at']}, but at {times}"
    if line.foreign < len(shown["interference"]):
        yield f"there are {line.foreign} events of others that commanded, shown are {shown['interference']}"


def _unlike(whose: str, shown: Row, expected: Row) -> Iterator[str]:
    for key, value in expected.items():
        if key not in shown:
            yield f"{whose}: nothing is shown for {key}"
        elif shown[key] != value and not _same(shown[key], value):
            yield f"{whose}: {key} is shown as {shown[key]!r}, it is {value!r}"


def _same(shown: Any, value: Any) -> bool:
    if isinstance(shown, float) and isinstance(value, float):
        return abs(shown - value) <= EXACT
    return bool(shown == value)


def _plant(look: Look) -> Row:
    plant, model = look.world.plant, look.world.model
    return {
        "plant": model.name,
        "epoch": plant.epoch,
        "at": look.record.step.at,
        "ending": False,
        "zones": [_zone(look, zone) for zone in model.zones],
    }


def _zone(look: Look, zone: str) -> Row:
    zones = look.world.plant.zones
    robot = zones.holder(zone)
    word = "free" if robot is None else "quarantined" if zones.is_quarantined(zone) else "held"
    waiting = [name for name, wanted in zones.queue.waiting if zone in wanted]
    return {"zone": zone, "state": word, "robot": robot, "waiting": waiting}


def _cell(look: Look, cell: KnownCell) -> Row:
    tasks, run, now = look.record.tasks, cell.run, look.record.step.at
    arm, mobile = cell.cell.taker.robot, cell.cell.giver.robot
    expected: Row = {
        "state": cell.state.value,
        "arm": arm.name,
        "mobile": mobile.name,
        "devices": [_device("arm", arm, "effector"), _device("mobile", mobile, None)],
        "queue": list(tasks.queues[cell.name]),
        "paused": cell.paused,
    }
    if not tasks.queues[cell.name]:
        expected["waiting_for"] = None
    if cell.state is not CellState.HELD:
        expected["held_by"] = None
    if cell.state is not CellState.IDLE or (not cell.paused and ready(look, cell)):
        expected["not_ready"] = None
    if cell.state is CellState.EXECUTE:
        expected["advice"] = []
    running = tasks.open.get(tasks.running.get(cell.name, ""))
    if running is None:
        expected["task"] = None
    if run.tree is None:
        expected |= {"tree": [], "step": None, "progress": None}
    shown = view.task_by_id(look.world.plant, running.id) if running else None
    if running is not None:
        began = {"started_at": running.since, "elapsed_s": now - running.since, "ended_at": None}
        expected["task"] = {**(shown or {}), **began, "id": running.id, "cell": cell.name, "state": "running"}
    return expected


def _device(role: str, robot: Robot, holds: str | None) -> Row:
    place = robot.position_key
    return {"role": role, "name": robot.name, "kind": role, "position": place, "holds": holds, "asked": False}


def _tasks(look: Look, shown: Row) -> Iterator[str]:
    tasks = look.record.tasks
    for row in shown["tasks"]:
        known = tasks.open.get(row["id"]) or tasks.ended.get(row["id"])
        if known is not None:
            yield from _unlike(f"task {known.id}", row, rows.task(known))
            yield from rows.times(known, row, look.record.step.at)


def _obstacle(look: Look, known: KnownRobot, row: Row) -> Iterator[str]:
    allowed = rows.obstacle(known, look.record.step.at, look.world.plant.epoch)
    sentence = row["obstacle"]
    if allowed is not None and (sentence.phrase not in allowed if sentence else allowed):
        yield f"{known.robot.name}: {sentence!r} is shown as what is in its way, it is one of {allowed}"
    last = look.record.commands.last.get(known.robot.name)
    expected = rows.command(last, look.record.step.at)
    if expected is None or expected["state"] is None:
        return
    yield from _unlike(known.robot.name, row["command"] or {}, expected)


def _tree(cell: KnownCell, rows_: list[Row], now: float, *, own: bool) -> Iterator[str]:
    """Differences between the tree shown and the tree; `own`: it may have nodes that nobody translates."""
    tree = cell.run.tree
    if tree is None:
        return
    if len(rows_) != len(nodes_of(tree)):
        yield f"{cell.name}: {len(rows_)} nodes are shown of a tree with more or less"
    for row in rows_:
        node = _node(tree, row["path"])
        if row["name"].phrase is OWN and not own:
            yield f"{cell.name}: {row['path']} is shown as {row['name']} in every language"
        if str(row["name"]) != node.name or row["status"] != STATUSES[node.status]:
            yield f"{cell.name}: {row['path']} is shown as {row['name']} {row['status']}"
        entry = getattr(node, "entry", None)
        if entry is not None and row["parameters"].get("command") != entry.command.id:
            yield f"{cell.name}: {row['path']} is shown with {row['parameters']}"
        if entry is not None and row["kind"] != "command":
            yield f"{cell.name}: {row['path']} is shown as a {row['kind']}"
        yield from rows.node(cell, node, row, now)
        left = row["deadline_s"]
        if left is not None and left < -EXACT:
            yield f"{cell.name}: {row['path']} is shown with {left} s left"


def _node(tree: Behaviour, path: str) -> Behaviour:
    for number in () if path == "root" else path.split("."):
        tree = tree.children[int(number)]
    return tree


def _robot(look: Look, known: KnownRobot) -> Row:
    now, robot = look.record.step.at, known.robot
    last = look.record.commands.last.get(robot.name)
    is_arm = bool(robot.joints)
    kept = look.record.facts.effector(robot.name)
    return {
        "mqtt": robot.mqtt,
        "online": not known.offline(now),
        "state": known.state.value if known.state is not None else None,
        "age_s": None if known.heard_at is None else now - known.heard_at,
        "q": known.q,
        "node": known.node,
        "homed": known.homed,
        "latched": known.stop is StopProgress.LATCHED,
        "effector": known.effector,
        "piece": known.piece,
        "facts": _facts(known) if is_arm else {},
        "boot_id": known.boot,
        "bridge_epoch": known.epoch,
        "holding": kept != "off" if is_arm else None,
        "units": [_unit(joint) for joint in robot.joints] if robot.joints else None,
        "goal": _goal(last),
    }


def _facts(known: KnownRobot) -> Row:
    """The last words of an arm on its tool."""
    return {"effector": known.effector, **({} if known.piece is None else {"piece": known.piece})}


def _unit(joint: Any) -> str:
    return "m" if joint.pinion_radius_m else "rad"


def _goal(last: SentCommand | None) -> Row | None:
    """The goal of a command that has not ended; None if it has."""
    if last is None or last.state not in GOING:
        return None
    if isinstance(last.command, MoveJoints):
        return {"q": list(last.command.q)}
    return {"nodes": list(last.command.nodes)} if isinstance(last.command, FollowPath) else None


def _diagnoses(shown: Row) -> Iterator[str]:
    diagnoses = {each[0]: each[1:] for each in diagnostics.diagnostics(shown)}
    for robot in shown["robots"]:
        whose, level, message, values = diagnoses.pop(f"arboleda: {robot['name']}", (None, None, "", {}))
        yield from rows.of_robot(robot, values)
        bad = robot["state"] not in (None, 0, 1)
        expected = STALE if not robot["online"] else ERROR if bad else OK
        if (whose, level, message) != (robot["mqtt"], expected, str(robot["obstacle"] or "ready")):
            yield f"{robot['name']} has the diagnosis {level} {message!r}"
    for cell in shown["cells"]:
        _, level, message, values = diagnoses.pop(f"arboleda: {cell['name']}", (None, None, "", {}))
        well = cell["state"] in ("idle", "execute") and not cell["paused"] and not cell["not_ready"]
        if level != (OK if well else WARN) or not message or values != rows.of_cell(cell):
            yield f"{cell['name']} has the diagnosis {level} {message!r} {values}"
    if diagnoses:
        yield f"there are diagnoses of {sorted(diagnoses)}"


def _drawn(look: Look, drawn: Row) -> Iterator[str]:
    for row in drawn["robots"]:
        known = look.record.robots[row["name"]]
        expected = _robot(look, known)
        wanted = {key: expected[key] for key in ("online", "q", "node", "goal")}
        wanted["homed"] = not known.unhomed if known.robot.evidence.value == "ids" else row["homed"]
        yield from _unlike(f"{row['name']} as drawn", row, {**wanted, "heard_at": known.heard_at})
        yield from _ends(look, known, row)
    for name, part in drawn["parts"].items():
        kept = look.record.facts.effector(look.record.cells[name].cell.taker.robot.name)
        if look.world.model.cell(name).places:
            yield from _in_hands(name, part, drawn["books"][name]["carriers"], kept)
            continue
        if (part is not None and part["at"] == "arm") is not (kept != "off"):
            yield f"the part of {name} is drawn at {part}, its effector is {kept}"
        if kept != "off" and part is not None and part.get("sure") is not (kept == "on"):
            yield f"the part of {name} is drawn as {part}, its effector is {kept}"
        running = look.record.tasks.open.get(look.record.tasks.running.get(name, ""))
        cell = look.record.cells[name]
        own, task = _is_own(look, cell), cell.run.task
        if not own and kept == "off" and running is not None and task and cell.run.tree is not None:
            yield from rows.waits_at(cell, cell.cell.recipe(task.order.recipe), part)


def _in_hands(name: str, part: Row | None, carriers: dict[str, bool], kept: str) -> Iterator[str]:
    """Differences between the parts that are drawn in hands by the books of a cell, and its effector."""
    expected = [] if kept == "off" else [kept == "on"]
    if part is not None or list(carriers.values()) != expected:
        yield f"the parts of {name} are drawn at {part} and in {carriers}, its effector is {kept}"


def _ends(look: Look, known: KnownRobot, row: Row) -> Iterator[str]:
    """Differences in since when a robot goes, where it came to, and when it said where it is."""
    name = known.robot.name
    last = look.record.commands.last.get(name)
    reached = rows.ended_at(known.robot, last, reached_of(look.world.plant).get(name))
    goes = last is not None and last.state in (State.RUNNING, State.CANCELLING)
    since = row["going_since"]
    if row["reached"] != reached or (since is not None and (last is None or last.state not in OPEN)):
        yield f"{name} is drawn going since {since}, at {row['reached']}; it came to {reached}"
    if goes and last is not None and last.cancelled_at is None and not (since and since >= last.at):
        yield f"{name} is drawn going since {since}, its command left at {last.at}"
    known_place = known.q if known.robot.joints else known.node
    if (row["position_at"] is None) is not (known_place is None):
        yield f"{name} is drawn as of {row['position_at']}, it has said {known_place}"
    age_s = math.inf if row["position_at"] is None else look.record.step.at - row["position_at"]
    speaks = known.robot.evidence is not Evidence.STATE  # at `state` it may be silent for long
    if row["reports"] is not (speaks or age_s <= look.world.model.timing.stale_after_s):
        yield f"{name} is drawn as {'' if row['reports'] else 'not '}reporting, it did {age_s} s ago"


@invariant(Trigger.NEWS)
def screens_are_told_of_news(look: Look) -> Iterable[str]:
    """Whenever a cell or a task changes, so does the number by which screens know that they are behind."""
    if look.record.step.unnumbered:
        return [f"cells or tasks changed, and what is shown is still number {look.world.plant.version}"]
    return NOTHING


@invariant(Trigger.SAID)
def status_says_the_report(look: Look) -> Iterable[str]:
    """A report that goes over ROS 2 arrives as it left; a status that no bridge can mean is refused."""
    if not look.record.checked.due_for("status", look.world.now, STATUS_S):
        return NOTHING
    return (
        *_carried(look),
        *(_broken(look) if look.record.checked.due_for("garbled", look.world.now, GARBLED_S) else NOTHING),
    )


def _carried(look: Look) -> Iterator[str]:
    for report in look.record.heard.anew:
        robot = look.world.model.robots.get(report.robot)
        if robot is None or not look.record.checked.is_new(f"status of {robot.name}", report.words):
            continue
        try:
            sent = status.to_status(robot, report)
            received = status.from_status(report.at, robot, sent)
        except Exception as error:  # noqa: BLE001 - whatever it is, the report does not arrive
            yield f"{report} cannot be told over ROS 2: {error}"
            continue
        if received != report:
            yield f"{report} arrives over ROS 2 as {received}"
        refused = sent.message == "command refused"
        if sent.hardware_id != robot.mqtt or refused is not (report.state is None):
            yield f"{report} is told over ROS 2 as {sent.message!r} of {sent.hardware_id}"


def _broken(look: Look) -> Iterator[str]:
    """The last report, garbled as other nodes may garble it."""
    report = look.record.heard.anew[-1]
    robot = look.world.model.robots.get(report.robot)
    if robot is None:
        return
    sent = status.to_status(robot, report)
    if not look.record.checked.is_new(f"garbled {robot.name}", (sent.message, *sent.values)):
        return
    garbled = [replace(sent, values={**sent.values, key: value}) for key, value in GARBLED]
    if robot.joints:
        endless = ",".join(["1e999"] * len(robot.joints))
        garbled.append(replace(sent, values={**sent.values, "q": endless}))
    alone = {key: value for key, value in sent.values.items() if key != "reason"} | {"rejected": "1-1"}
    for each in (*garbled, replace(sent, name=f"arboleda: {robot.name}2"), replace(sent, values=alone)):
        try:
            received = status.from_status(report.at, robot, each)
        except PayloadError:
            continue
        yield f"{each} is taken for {received}"


@invariant(Trigger.END)
def plans_show_the_model(look: Look) -> Iterator[str]:
    """The values that never change are shown as in the plant file."""
    if not _only_arms_and_mobiles(look):
        return
    model = look.world.model
    shown = {row["name"]: row for row in view.layout(model)["cells"]}
    placed = geometry.places(model)
    stand = {row["name"]: row for row in placed["robots"]}
    around = {row["name"]: row for row in placed["cells"]}
    without_stop = [robot.name for robot in model.robots.values() if not robot.has_stop]
    yield from _unlike(
        "the plant",
        view.layout(model),
        {"plant": model.name, "zones": list(model.zones), "no_stop": without_stop, "places": placed},
    )
    for cell in model.cells:
        arm, mobile = cell.taker.robot, cell.giver.robot
        grid = mobile.floor_grid
        yield from _unlike(
            cell.name,
            shown[cell.name],
            {
                "arm": arm.name,
                "mobile": mobile.name,
                "grid": {"rows": grid.rows, "columns": grid.columns},
                "paths": {path.code: list(path.nodes) for path in cell.giver.paths},
                "stations": len(cell.stations),
            },
        )
        for robot in cell.robots:
            yield from _unlike(robot.name, stand[robot.name], PLACED[type(robot)](cell, robot))
        yield from _unlike(f"the place of {cell.name}", around[cell.name], rows.place(cell))
    for row in placed["zones"]:
        yield from _spots(look, row)


def _arm_placed(cell: Any, arm: Arm) -> Row:
    at = [arm.base.x, arm.base.y, arm.base.yaw]
    zero = [0.0] * len(arm.joints)
    speeds = [joint.speed for joint in arm.joints]
    return {"cell": cell.name, "kind": "arm", "at": at, "reference": zero, "speeds": speeds}


def _mobile_placed(cell: Any, mobile: Mobile) -> Row:
    grid = mobile.grid
    rows = range(grid.rows)
    nodes = [[column * grid.pitch, row * grid.pitch] for row in rows for column in range(grid.columns)]
    at = [grid.origin.x, grid.origin.y, grid.origin.yaw]
    return {
        "cell": cell.name,
        "kind": "mobile",
        "at": at,
        "nodes": nodes,
        "reference": nodes[0],
        "speeds": [mobile.speed] * 2,
    }


def _spots(look: Look, row: Row) -> Iterator[str]:
    cells, zone = look.world.model.cells, row["zone"]
    spaces = [space for cell in cells for space in cell.spaces]
    inside = sum(zone in pose.zones for space in spaces for pose in space.poses)
    ways = sum(zone in way.zones for space in spaces for way in space.crossings)
    if len(row["spots"]) != inside + ways:
        yield f"zone {zone} is shown with {len(row['spots'])} spots"


GARBLED = (
    ("state", "9"),
    ("state", ""),
    ("q", "1.0,nan"),
    ("q", "0.1,,0.2"),
    ("node", "-1"),
    ("homed", "True"),
    ("epoch", "4294967296"),
    ("boot_id", "1.0"),
    ("accepted", "1 1"),
    ("done", ""),
    ("foreign", ""),
    ("foreign", "\x1b[31m"),
    ("foreign", "x" * 301),
)
PLACED: dict[type, Callable[[Any, Any], Row]] = {Arm: _arm_placed, Mobile: _mobile_placed}

SCREENS = (screens_show_what_is, screens_are_told_of_news, status_says_the_report, plans_show_the_model)
