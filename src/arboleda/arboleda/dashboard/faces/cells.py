"""The cells: what each is doing, its tree, and what its tree did last."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.drawing.folding import folded, shown_at, small_steps
from arboleda.drawing.layout import parent
from arboleda.model.messages import Outcome
from arboleda.views.view import devices_once, standing

from ..tree_drawing import drawing, label
from ..tree_memory import FAILURE, HALTED, RUNNING, SUCCESS, EndedTree, TreeMemory, phases
from ..wording import Words
from . import Face, advice, answers, links
from .moment import Moment, clock, seconds

SHOWN_CHANGES = 12
SHOWN_ANSWERS = 4
GIVEN_UP = ("command", "await")  # kinds of steps that a deadline ends
Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {}
    robots = {robot["name"]: robot for robot in moment.snapshot["robots"]}
    devices: dict[str, list[Row]] = {cell["name"]: [] for cell in moment.snapshot["cells"]}
    for name, device in devices_once(moment.snapshot["cells"]):
        devices[name].append(device)
    for cell in moment.snapshot["cells"]:
        memory = moment.trees[cell["name"]]
        found.update(_card(moment, cell, memory))
        leaf = memory.leaf["path"] if memory.leaf else None
        rests = cell["state"] == "held"
        found.update(tree_face(moment.words, cell["name"], memory, leaf=leaf, rests=rests))
        found.update(_changes(moment, cell["name"], memory))
        found.update(_devices(moment, cell["name"], devices[cell["name"]], robots))
        found.update(_last_answers(moment, cell, devices[cell["name"]]))
    return found


def _card(moment: Moment, cell: Row, memory: TreeMemory) -> Face:
    words, name = moment.words, cell["name"]
    task = cell["task"] or _last_task(moment, memory)
    leaf = memory.leaf
    stands = standing(cell)
    failed = task is not None and task["state"] == "failed"
    state = "failed" if stands == "idle" and failed else stands
    return {
        f"text/{name}.state": words.cell_pill(stands),
        f"text/{name}.cause": [_cause(words, cell, task, memory), "failed" if failed else ""],
        f"text/{name}.report": _report(words, cell, task),
        f"text/{name}.failure": [words("record.link") if name in moment.failed else "", ""],
        **advice.face(words, cell),
        f"text/{name}.task": _task_line(moment, cell, task),
        f"text/{name}.step": [words.say(cell["step"]) if cell["step"] else "", stands],
        f"text/{name}.feedback": [_feedback(words, cell, leaf), ""],
        f"text/{name}.elapsed": [seconds(cell["task"]["elapsed_s"]) if cell["task"] else "", ""],
        f"text/{name}.left": [_left(moment, leaf), ""],
        f"text/{name}.queue": [_queue(moment, cell), "paused" if cell["paused"] else ""],
        f"text/{name}.offer": [_offered(words, cell, stands), ""],
        f"text/{name}.act": _act(moment, cell),
        f"text/{name}.trouble": [trouble(moment, cell), state],
        f"bar/{name}.progress": progress(memory.rows, memory.statuses) if cell["task"] else None,
    }


def _devices(moment: Moment, name: str, devices: list[Row], robots: dict[str, Row]) -> Face:
    """A row for each device of a cell that no drawing shows: its facts and its last command."""
    shown = [each["name"] for each in devices if each["position"] is None]
    found: Face = {f"rows/devices.{name}": shown} if shown else {}
    for device in shown:
        robot = robots[device]
        texts = [device, links.says(moment.words, robot), links.command(moment, robot)]
        found[f"row/devices.{name}/{device}"] = {"state": links.state(robot), "texts": texts}
    return found


def _last_answers(moment: Moment, cell: Row, devices: list[Row]) -> Face:
    """The last answers to the task of a cell, if one of its devices can answer."""
    if all(each["position"] for each in devices):
        return {}
    given = cell["task"]["answers"] if cell["task"] else []
    return answers.rows(moment.words, f"heard.{cell['name']}", given, SHOWN_ANSWERS)


def _cause(words: Words, cell: Row, task: Row | None, memory: TreeMemory) -> str:
    """The reason for which the last task failed and the step it failed in; empty once the cell is at work
    again.

    The reason for a stop is left out, as the cell itself shows it.
    """
    if task is not None and task["reason"] == "stopped" and cell["state"] in ("aborting", "aborted"):
        return ""
    if task is None or cell["state"] == "execute" or task["state"] != "failed":
        return ""
    return failed_in(words, task, memory.rows)


def remark(words: Words, task: Row) -> str:
    """The sentence of a task that is done about a result that nobody confirmed."""
    return words.say(task["sentence"]) if task["state"] == "done" else ""


def _act(moment: Moment, cell: Row) -> list[str]:
    """The last thing that an operator had devices of the cell do, while they do it; if it failed, until the
    cell has worked again."""
    words = moment.words
    act = next((act for act in reversed(moment.snapshot["acts"]) if act["cell"] == cell["name"]), None)
    if act is None:
        return ["", ""]
    if act["outcome"] == Outcome.UNDER_WAY:
        return [words("cells.act_under_way", did=words.say(act["sentence"])), act["outcome"]]
    tells = act["ended"] is not None and act["outcome"] != Outcome.DONE
    if not tells or _has_worked_since(moment, cell, act["at"]):
        return ["", ""]
    return [words.say(act["ended"]), act["outcome"]]


def _has_worked_since(moment: Moment, cell: Row, at: float) -> bool:
    tasks = (task for task in moment.snapshot["tasks"] if task["cell"] == cell["name"])
    begun = any(task["started_at"] is not None and task["started_at"] > at for task in tasks)
    return begun or cell["state"] == "execute" or not (cell["advice"] or cell["not_ready"])


def _report(words: Words, cell: Row, task: Row | None) -> list[str]:
    """The link to the report of the last task, while the card says that it failed; its state is the id."""
    over = cell["state"] != "execute" and task is not None and task["state"] == "failed"
    return [words("report.link"), task["id"]] if over and task else ["", ""]


def failed_in(words: Words, task: Row, rows: list[Row]) -> str:
    """The reason for which a task failed, and the step of its tree that it failed in."""
    where = task["failed_in"] and shown_at(task["failed_in"], rows)
    step = next((row["name"] for row in rows if row["path"] == where), None)
    why = words.say(task["sentence"])
    return why if step is None else words("cells.failed_in", step=words.say(step), why=why)


def _task_line(moment: Moment, cell: Row, task: Row | None) -> list[str]:
    """The task of a card and how it ended: a warning where it is done and nobody confirmed some of it."""
    words = moment.words
    if task is None:
        return [words("cells.no_task"), "none"]
    ended = "" if task["ended_at"] is None else words.of("task_state", task["state"])
    line, unconfirmed = f"{task['text']}  {ended}".strip(), remark(words, task)
    if unconfirmed and cell["state"] != "execute":
        return [f"{line}, {unconfirmed}", "warning"]
    return [line, task["state"]]


def _last_task(moment: Moment, memory: TreeMemory) -> Row | None:
    return next((task for task in moment.snapshot["tasks"] if task["id"] == memory.task), None)


def trouble(moment: Moment, cell: Row) -> str:
    """The sentence about what keeps a cell from working; "" if nothing does."""
    words = moment.words
    if cell["held_by"]:
        return words.say(cell["held_by"])
    if cell["state"] not in ("idle", "execute"):
        return words(f"next.{cell['state']}", cell=cell["name"])
    return words.say(cell["not_ready"]) if cell["not_ready"] else ""


def _offered(words: Words, cell: Row, stands: str) -> str:
    """The invitation to give a task to an idle cell that is ready for one."""
    free = stands == "idle" and cell["task"] is None and not cell["queue"]
    return words("cells.offer", cell=cell["name"]) if free else ""


def _feedback(words: Words, cell: Row, leaf: Row | None) -> str:
    """The feedback of the step that runs now; empty for a cell that is held."""
    return words.say(leaf["feedback"]) if leaf and leaf["feedback"] and cell["state"] != "held" else ""


def _left(moment: Moment, leaf: Row | None) -> str:
    if leaf is None or leaf["deadline_s"] is None or leaf["kind"] not in GIVEN_UP:
        return ""
    return moment.words("cells.left", time=seconds(leaf["deadline_s"]))


def _queue(moment: Moment, cell: Row) -> str:
    waiting = len(cell["queue"])
    if cell["paused"]:
        key = "cells.queue_paused" if waiting else "cells.queue_paused_empty"
        return moment.words(key, count=waiting)
    return moment.words("cells.queue", count=waiting) if waiting else ""


def progress(rows: list[Row], statuses: dict[str, str]) -> float:
    """The share of the steps that are done: those of the work, or of the recovery once that runs."""
    found = phases(rows)
    active = [row for row in found if statuses.get(row["path"]) == RUNNING] or found[:1]
    steps = [over for phase in active for over in _steps(rows, statuses, phase, done=False)]
    return round(sum(steps) / len(steps), 3) if steps else 0.0


def _steps(rows: list[Row], statuses: dict[str, str], frame: Row, *, done: bool) -> list[bool]:
    """A bool for each step of a frame, True once it is done; counted as in `tree_view.progress_of`."""
    nodes = [row for row in rows if parent(row["path"]) == frame["path"]]
    if frame["kind"] == "selector":
        nodes = [row for row in nodes if statuses.get(row["path"]) in (RUNNING, SUCCESS)]
    found: list[bool] = []
    for row in nodes:
        over = done or statuses.get(row["path"]) == SUCCESS
        found += _steps(rows, statuses, row, done=over) if row["frame"] else [over]
    return found or [done]


def tree_face(
    words: Words,
    name: str,
    tree: TreeMemory | EndedTree,
    *,
    leaf: str | None = None,
    rests: bool = False,
    title: str = "",
) -> Face:
    """The face of a tree under this name; `leaf` is the path of the running leaf, `rests` for a held cell."""
    rows, inside = folded(tree.rows), small_steps(tree.rows)
    current = leaf and shown_at(leaf, tree.rows)
    nodes = [
        {
            "path": row["path"],
            "name": words.say(row["name"]),
            "label": label(row["name"], row["kind"], words),
            "kind": row["kind"],
            "about": _about(words, row, inside.get(row["path"], ())),
        }
        for row in rows
    ]
    drawn = drawing(tuple((row["path"], row["name"], row["kind"]) for row in rows), words)
    found: Face = {f"tree/{name}": {"task": tree.task, "title": title or name, "nodes": nodes, **drawn}}
    for row in rows:
        found[f"node/{name}/{row['path']}"] = _node(words, row, tree, current, rests=rests)
    return found


def _about(words: Words, row: Row, inside: Sequence[Row]) -> str:
    """The purpose of a node, and the small steps that it shows."""
    about = row["description"] or words.of("kind", row["kind"])
    steps = ", ".join(words.say(each["name"]) for each in inside)
    return f"{about} {words('node.inside', steps=steps)}".strip() if steps else about


def _node(words: Words, row: Row, tree: TreeMemory | EndedTree, leaf: str | None, *, rests: bool) -> Row:
    status = tree.statuses.get(row["path"], "idle")
    if rests and status == RUNNING:
        status = HALTED
    running = status == RUNNING and leaf is not None
    return {
        "state": status,
        "word": words.of("status", status),
        "current": row["path"] == leaf and not rests,
        "feedback": words.say(row["feedback"]) if running and row["feedback"] else "",
        "failure": words.say(row["failure"]) if row["failure"] else "",
        "failed": status == FAILURE,
        "since": seconds(row["since_s"]) if running else "",
        "left": seconds(row["deadline_s"]) if running else "",
        "given": [[words.of("parameter", key), _value(value)] for key, value in row["parameters"].items()],
    }


def _value(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    if isinstance(value, list | tuple):
        return ", ".join(f"{each:.4g}" if isinstance(each, float) else str(each) for each in value)
    return str(value)


def _changes(moment: Moment, cell: str, memory: TreeMemory) -> Face:
    """The rows of the last changes of status, the newest first."""
    last = list(memory.changes)[-SHOWN_CHANGES:][::-1]
    found: Face = {f"rows/changes.{cell}": [str(change.number) for change in last]}
    for change in last:
        texts = [clock(change.at), moment.words.say(change.name), moment.words.of("status", change.status)]
        found[f"row/changes.{cell}/{change.number}"] = {"state": change.status, "texts": texts}
    return found
