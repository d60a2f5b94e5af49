"""Rows of tasks, trees, diagnoses and places as a screen must show them, written down here once more."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.drivers import FollowPath, MotionState, MoveJoints, Position, Robot
from arboleda.engine import OPEN, State
from arboleda.engine.inspection import (
    BACK_AT_ZERO,
    FAULTY,
    FENCED,
    HELD,
    HELD_STRANDED,
    IN_RECOVERY,
    MOVING,
    OFFLINE,
    STOPPED,
    UNANSWERED,
    UNHEARD,
    UNHOMED,
)
from arboleda.model.advice import Advice, sentence
from arboleda.model.messages import ENDED, Reason, TaskChanged
from arboleda.model.plant_model import Cell
from arboleda.model.tree_nodes import nodes_of
from arboleda.recipes import Phrase, Recipe, Sentence

from ..recorded.cells import KnownCell
from ..recorded.commands import SentCommand
from ..recorded.robots import KnownRobot, StopProgress
from ..recorded.tasks import KnownTask

Row = dict[str, Any]
EXACT = 1e-6
WORDS = {
    "Selector": "selector",
    "Sequence": "sequence",
    "Act": "command",
    "Announce": "notice",
    "Carry": "note",
    "Dwell": "dwell",
}  # kinds of nodes by class; classes that are not here may have subclasses
UNTOLD = ("age_s", "telemetry_hz")  # change all the time


def line(change: TaskChanged) -> Row:
    """The row for one change of a task, for people who follow it."""
    return {
        "id": change.task,
        "text": change.text,
        "cell": change.cell,
        "state": change.state.value,
        "reason": None if change.reason is None else change.reason.value,
        "sentence": change.sentence,
    }


def task(known: KnownTask) -> Row:
    """The row of a task as it was told, without its times."""
    change = known.message
    expected: Row = {"text": change.text, "cell": known.cell, "state": known.state.value}
    if known.state in ENDED:  # a recovering task has its reason before that is told
        expected |= {"reason": change.reason.value if change.reason else None, "sentence": change.sentence}
    return expected


def times(known: KnownTask, row: Row, now: float) -> Iterator[str]:
    """Differences between the times shown of a task and when it was told to run, and to have ended."""
    began = known.began
    ended = known.since if known.state in ENDED else None
    elapsed = None if began is None else (now if ended is None else ended) - began
    for key, value in (("started_at", began), ("ended_at", ended), ("elapsed_s", elapsed)):
        if (row[key] is None) is not (value is None) or abs((row[key] or 0.0) - (value or 0.0)) > EXACT:
            yield f"task {known.id}: {key} is shown as {row[key]}, it is {value}"


def queue(cell: KnownCell, row: Row, *, own: bool) -> Iterator[str]:
    """Differences in what is shown of a cell's queue: why no task starts, who holds it, its progress."""
    state, name = row["state"], cell.name
    waits = row["queue"] and (state != "idle" or row["paused"])
    if waits and not row["waiting_for"]:
        yield f"{name} is {state}, its tasks are shown to wait for {row['waiting_for']!r}"
    if state == "held" and not _says_held(name, row["held_by"]):
        yield f"{name} is held, by what is shown by {row['held_by']!r}"
    if not own:  # other recipes may count their steps otherwise
        yield from _progress(cell, row)


def _says_held(cell: str, sentence: Sentence | None) -> bool:
    return (
        sentence is not None and sentence.phrase in (HELD, HELD_STRANDED) and sentence.values["cell"] == cell
    )


def _steps(frame: Behaviour) -> Iterator[Behaviour]:
    """The steps in a frame and in its inner frames."""
    for node in frame.children:
        yield from _steps(node) if getattr(node, "frame", False) else (node,)


def _progress(cell: KnownCell, row: Row) -> Iterator[str]:
    tree = cell.run.tree
    if tree is None:
        return
    work = next((phase for phase in tree.children if phase.name == "main"), None)
    done = [each.status is Status.SUCCESS for each in _steps(work)] if work is not None else []
    shown = row["progress"]
    if (shown is None) is bool(done):
        yield f"{cell.name}: {shown} of the work is shown as done, it has {len(done)} steps"
    elif done and ((shown > 0) is not any(done) or (shown == 1) is not all(done) or not 0 <= shown <= 1):
        yield f"{cell.name}: {shown} of the work is shown as done, of its {len(done)} steps {sum(done)} are"
    runs = [node.name for node in nodes_of(tree) if node.status is Status.RUNNING]
    sentence = row["step"]
    step = str(
        sentence.values["step"] if sentence is not None and sentence.phrase is IN_RECOVERY else sentence or ""
    )
    if bool(runs) is not bool(step) or (step and step not in runs):
        yield f"{cell.name}: {row['step']!r} is shown as the step, {runs} run"


def node(cell: KnownCell, there: Behaviour, row: Row, now: float) -> Iterator[str]:
    """Differences between the row of a tree's node and the node: kind, words, seconds that have passed."""
    where = f"{cell.name}: {row['path']}"
    word = WORDS.get(type(there).__name__)
    if word is not None and row["kind"] != word:
        yield f"{where} is shown as a {row['kind']}, it is a {word}"
    message = there.feedback_message
    failed = there.status is Status.FAILURE and message
    if str(row["feedback"]) != message or (failed and str(row["failure"]) != message):
        yield f"{where} is shown with {row['feedback']!r} and {row['failure']!r}"
    seconds = getattr(there, "seconds", None)
    timed = seconds is not None and row["kind"] in ("dwell", "await")
    if timed and row["parameters"].get("seconds") != seconds:
        yield f"{where} is shown with {row['parameters']}, it waits {seconds} s"
    entry = getattr(there, "entry", None)
    if entry is not None and row["kind"] == "command":
        yield from _command(where, there, row, now)
    elif timed and row["since_s"] is not None:
        passed, left = row["since_s"], row["deadline_s"]
        if abs(left - max(seconds - passed, 0.0)) > EXACT or passed < -EXACT:
            yield f"{where} is shown {passed} s old with {left} s left of {seconds}"


def _command(where: str, there: Any, row: Row, now: float) -> Iterator[str]:
    entry, given = there.entry, row["parameters"]
    expected = {each.name: getattr(entry.command, each.name) for each in fields(entry.command)}
    expected["command"] = expected.pop("id")
    if {key: given.get(key) for key in expected} != expected or given.get("tries", 1) != there.tries + 1:
        yield f"{where} is shown with {given}, it was given {expected} at try {there.tries + 1}"
    if there.status is Status.RUNNING and there.again_at is None and entry.state in OPEN:
        if row["since_s"] is None or abs(row["since_s"] - (now - entry.sent_at)) > EXACT:
            yield f"{where} is shown to run for {row['since_s']} s"
        if row["deadline_s"] is None or abs(row["deadline_s"] - (entry.deadline - now)) > EXACT:
            yield f"{where} is shown with {row['deadline_s']} s left"


def command(last: SentCommand | None, now: float) -> Row | None:
    """The row of a robot's last command."""
    if last is None:
        return None
    state, what = (last.state.value, last.entry.doing) if last.state and last.entry else (None, None)
    return {"id": last.command.id, "what": what, "state": state, "age_s": now - last.at}


def rejected(last: SentCommand | None, row: Row) -> Iterator[str]:
    """A robot that refused its last command is shown to have done so."""
    failure = last.entry.failure if last is not None and last.entry is not None else None
    if failure is not None and failure.reason is Reason.REJECTED and not row["rejected"]["count"]:
        yield f"{row['name']} refused its last command, and is shown with {row['rejected']}"


def ways(advised: tuple[Advice, ...], row: Row) -> Iterator[str]:
    """Differences between the advice shown, as steps and as one sentence, and the plant's advice."""
    whole = str(sentence(advised))
    if len(advised) != len(row["advice"]):
        yield f"{row['name']} is shown with {len(row['advice'])} steps of advice, there are {len(advised)}"
    for way, shown in zip(advised, row["advice"], strict=False):
        plain = {"do": way.do.value, "arguments": dict(way.arguments)}
        expected = {**vars(way), **plain, "moves": [*way.moves], "drops": [*way.drops]}
        if {key: shown[key] for key in expected} != expected:
            yield f"{row['name']} is shown with {shown}, it is {way}"
        if str(shown["said"]) not in whole:
            yield f"{row['name']}: {shown['said']} is not in {whole!r}"


def stands(row: Row) -> str:
    """The words of a cell's state."""
    if row["teaching"] is not None:
        return f"{row['state']}, manual"
    if row["state"] != "idle" or row["not_ready"] is None:
        return str(row["state"])
    only_paused = [each["do"] for each in row["advice"]] == ["resume"]
    return "idle, paused" if only_paused else "idle, blocked"


def obstacle(known: KnownRobot, now: float, plant: int) -> tuple[Phrase, ...] | None:
    """The phrases for why a robot takes no command; empty if nothing is in its way, None if unsure."""
    if known.stop is StopProgress.LATCHED:
        return (STOPPED.phrase,)
    if known.offline(now):
        return (OFFLINE.phrase,) if known.heard_at is not None else (UNHEARD.phrase,)
    if known.robot.link.value == "mqtt" and known.epoch is not None and known.plant != plant:
        return (UNANSWERED.phrase, FENCED.phrase)
    if known.state in (MotionState.FAULT, MotionState.STOP_LATCHED):
        return (FAULTY.phrase,) if known.state is MotionState.FAULT else (STOPPED.phrase,)
    if known.barred and known.state is not MotionState.MOVING:
        return (STOPPED.phrase,)
    if known.unhomed:
        returns = known.displaced and known.robot.assume_homed  # perhaps at its reference after a silence
        return (UNHOMED.phrase, BACK_AT_ZERO.phrase) if returns else (UNHOMED.phrase,)
    if not known.robot.says_homed:
        return None  # it may have lost its place as only its joints show
    return (MOVING.phrase,) if known.state is MotionState.MOVING else ()


def of_robot(row: Row, values: dict[str, str]) -> Iterator[str]:
    """The values of a diagnosis that are those of its robot's row, as words."""
    for key, value in row.items():
        if isinstance(value, dict) or value is None or key in UNTOLD:
            continue
        if values.get(key) != str(value):
            yield f"{row['name']} is diagnosed with {key} {values.get(key)!r}, it is {value!r}"
    hz = row["telemetry_hz"]
    if values.get("telemetry_hz") != (None if hz is None else f"{hz:.0f}") or "age_s" in values:
        yield f"{row['name']} is diagnosed with {values.get('telemetry_hz')} reports a second, it is {hz}"


def of_cell(row: Row) -> dict[str, str]:
    """The values of the diagnosis of a cell."""
    return {
        "state": row["state"],
        "queued": str(len(row["queue"])),
        "step": str(row["step"] or ""),
        "waiting_for": str(row["not_ready"] or row["waiting_for"] or ""),
        "advice": ", ".join(str(each["said"]) for each in row["advice"]),
    }


def ended_at(robot: Robot, last: SentCommand | None, at: Position | None) -> Row | None:
    """The place where the last motion of a robot ended, as far as that was proven; `at`: an arm's place."""
    if robot.joints:
        return {"q": list(at)} if isinstance(at, tuple) else None
    done = last is not None and last.state is State.DONE and isinstance(last.command, FollowPath)
    return {"node": last.command.nodes[-1]} if done else None  # type: ignore[union-attr]


def waits_at(cell: KnownCell, recipe: Recipe, part: Row | None) -> Iterator[str]:
    """Differences between the shown and the true place of a part that waits in no effector."""
    sent = [leaf.entry for leaf in _acts(cell) if leaf.entry is not None]
    sent.sort(key=lambda entry: entry.sent_at)
    letting_go = [entry for entry in sent if type(entry.command).__name__ == "SetEffector"]
    if letting_go:
        before = [each.command for each in sent[: sent.index(letting_go[-1])]]
        goals = [each.q for each in before if isinstance(each, MoveJoints)]
        stored = any(goals[-1] == station.q for station in cell.cell.stations) if goals else True
        expected = None if stored else {"at": "pose", "q": list(goals[-1])}
    elif recipe.part_from is not None:
        first = cell.cell.groups[recipe.part_from][0]
        expected = {"at": "pose", "q": list(cell.cell.taker.targets[first].joints)}
    else:
        expected = {"at": "mobile"}
    if part != expected:
        yield f"the part of {cell.name} is drawn at {part}, it is at {expected}"


def _acts(cell: KnownCell) -> Iterator[Any]:
    nodes = nodes_of(cell.run.tree) if cell.run.tree is not None else ()
    return (each for each in nodes if type(each).__name__ == "Act")


def place(cell: Cell) -> Row:
    """The values of a cell that never change; it has a handover."""
    assert cell.handover is not None
    grid = cell.giver.robot.floor_grid
    return {
        "arm": cell.taker.robot.name,
        "mobile": cell.giver.robot.name,
        "pitch": grid.pitch,
        "columns": grid.columns,
        "pickups": [list(pose.joints) for pose in cell.taker.at(cell.handover.targets)],
        "stations": [list(station.joints) for station in cell.stations],
    }
