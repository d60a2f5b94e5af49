"""The terminal's view of a plant: a live table on a terminal, else a line per change."""

from __future__ import annotations

import logging
import math
import os
import shlex
import stat
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from arboleda.core.cell_states import CellState
from arboleda.model.facts import Value, shown
from arboleda.model.messages import TaskChanged, TaskState
from arboleda.model.outside import plain
from arboleda.model.plant_model import MotionState
from arboleda.model.sentence import Sentence
from arboleda.views import view

REFRESH_HZ = 5
LONGEST = 1000  # characters of one text
OUTPUT_BYTES = 10_000_000  # of the file that standard output goes to; it goes on once the file is emptied
EFFECTOR = "effector"
SWITCHED = {True: "on", False: "off"}  # as an effector is, where other facts are so or not
MOST_ANSWERS = 3  # of a task that runs
ROLES = 3  # so many columns of robots a row of a cell may have; more are told below, a row for each
SHORT = ("cell", "state", "task", "time")  # columns that take one line, however narrow the terminal is
STATES = {
    None: "?",
    MotionState.STOPPED: "still",
    MotionState.MOVING: "at work",
    MotionState.FAULT: "fault",
    MotionState.NOT_HOMED: "not homed",
    MotionState.STOP_LATCHED: "latched",
    MotionState.NO_LINK: "no link",
}
STATE_WIDTH = 9  # letters of a task's state at the beginning of its line
STANDING = {"idle": "", "execute": "cyan", **dict.fromkeys(("manual", "paused", "blocked"), "yellow")}
STYLES = {
    TaskState.QUEUED: "dim",
    TaskState.RUNNING: "cyan",
    TaskState.DONE: "green",
    TaskState.FAILED: "bold red",
    TaskState.CANCELLED: "yellow",
    TaskState.REFUSED: "red",
}


class Screen:
    """Screen: shows `snapshot()` while the `with` block runs, and the lines of the log."""

    def __init__(self, console: Console, snapshot: Callable[[], dict[str, Any]], log_file: Path) -> None:
        self.console = console
        self._log_file = log_file
        self._full = False
        self._live = Live(
            console=console,
            get_renderable=lambda: table(snapshot()),
            refresh_per_second=REFRESH_HZ,
            transient=True,
        )
        self._steps: dict[str, str | None] = {}
        self._asked: dict[str, str | None] = {}

    def __enter__(self) -> Screen:
        if self.console.is_terminal:
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self.console.is_terminal:
            self._live.stop()

    def say(self, line: Text, at: float) -> None:
        """Print a line of the log, of `at` in s since 1970; with its time if no person looks on."""
        if self._is_full():
            return
        if not self.console.is_terminal:
            line = Text(time.strftime("%Y-%m-%d %H:%M:%S ", time.localtime(at))) + line
        self.console.print(line)

    def _is_full(self) -> bool:
        """True if the output is a file that has grown too large, as years of a service make it. Said once."""
        before, self._full = self._full, _size(self.console) >= OUTPUT_BYTES
        if self._full and not before:
            grown = f"this file has {OUTPUT_BYTES // 1_000_000} MB and gets no more lines"
            self.console.print(Text(f"{grown}; they go on in {self._log_file}"))
        return self._full

    def stepped(self, snapshot: dict[str, Any], at: float) -> None:
        """Without a terminal, print a line per step, and the questions to people, in place of the table."""
        if self.console.is_terminal:
            return
        for cell in snapshot["cells"]:
            if cell["step"] != self._steps.get(cell["name"]) and cell["step"] is not None:
                self.say(_words(f"  {cell['name']}: {cell['step']}"), at)
            self._steps[cell["name"]] = cell["step"]
        for robot in snapshot["robots"]:
            question_id = robot["question"] and robot["question"]["id"]
            if question_id != self._asked.get(robot["name"]):
                for line in _question(robot):
                    self.say(_words(line), at)
            self._asked[robot["name"]] = question_id


def logged(line: logging.LogRecord) -> Text:
    """A line of the log in its colours; the change of a task has those of its state."""
    change = getattr(line, "change", None)
    if change is None:
        style = "dim" if line.levelno < logging.WARNING else "yellow"
        return Text(line.getMessage(), style="red" if line.levelno >= logging.ERROR else style)
    text = Text(line.getMessage())
    text.stylize(STYLES[change.state], 0, STATE_WIDTH)
    text.stylize("bold", STATE_WIDTH + 1, STATE_WIDTH + 1 + len(change.text))
    return text


def table(snapshot: dict[str, Any]) -> Group:
    """The table with a row per cell: state, task, step, robots, time; below it other devices, zones,
    questions to people, answers to the tasks that run, and obstacles."""
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    columns = _columns(snapshot["cells"])
    headings = ["cell", "state", "task", "step", *columns, "time"]
    title = _words(f"plant {snapshot['plant']}", "italic")
    drawn = _table(headings, title=title, title_justify="left")
    for cell in snapshot["cells"]:
        drawn.add_row(*_row(cell, robots, by_role=bool(columns)))
    others = [] if columns else [_devices(snapshot["cells"], robots)]
    zones = [_zones(snapshot["zones"])] if snapshot.get("zones") else []
    questions = [_words(line, "cyan") for robot in snapshot["robots"] for line in _question(robot)]
    answers = [_words(line) for cell in snapshot["cells"] for line in _answers(cell)]
    troubles = [_words(line, "yellow") for line in _in_the_way(snapshot)]
    return Group(drawn, *others, *zones, *questions, *answers, *troubles)


def _table(headings: list[str], **settings: Any) -> Table:
    drawn = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), **settings)
    for heading in headings:
        drawn.add_column(heading, no_wrap=heading in SHORT)
    return drawn


def _columns(cells: list[dict[str, Any]]) -> list[str]:
    """The heading of each role, if every cell has the same few roles for robots that go somewhere."""
    headings = {tuple(_heading(device) for device in cell["devices"]) for cell in cells}
    moving = all(device["position"] for cell in cells for device in cell["devices"])
    return list(*headings) if len(headings) == 1 and moving and len(*headings) <= ROLES else []


def _heading(device: dict[str, Any]) -> str:
    return ", ".join(filter(None, (device["role"], device["holds"])))


def _devices(cells: list[dict[str, Any]], robots: dict[str, dict[str, Any]]) -> Table:
    """The table of the devices: state, facts and last command of each."""
    drawn = _table(["cell", "device", "kind", "state", "says", "last command"])
    for _, device in view.devices_once(cells):
        name = device["name"]
        robot = robots[name]
        state = STATES[robot["state"]] if robot["online"] else "offline"
        having = [cell["name"] for cell in cells if any(each["name"] == name for each in cell["devices"])]
        held = [f"held by {robot['holder']}"] if robot.get("holder") else []
        words = (
            ", ".join(having),
            name,
            device["kind"],
            state,
            ", ".join(filter(None, [says(robot), *held])),
            _told(robot),
        )
        drawn.add_row(*(_words(word, "" if robot["online"] else "dim") for word in words))
    return drawn


def _told(robot: dict[str, Any]) -> str:
    command, answer = robot["command"], robot["answer"]
    if command is None:
        return ""
    line = f"{command['what']}: {command['state']}"
    return line if answer is None else f"{line}, {answered(answer)}"


def says(robot: dict[str, Any]) -> str:
    """The position of a robot, and each of its facts by name."""
    facts = [f"{name} {fact(name, value)}" for name, value in robot["facts"].items()]
    return ", ".join([*place(robot), *facts])


def place(robot: dict[str, Any]) -> list[str]:
    """The reported position of a robot; empty if it reports none."""
    if robot["q"] is not None:
        return [joints(robot)]
    return [] if robot["node"] is None else [f"node {robot['node']}"]


def fact(name: str, value: Value | None) -> str:
    """A fact for a person; `?` if it was not reported yet."""
    if value is None:
        return "?"
    return SWITCHED[value] if name == EFFECTOR and isinstance(value, bool) else answered(value)


def answered(value: Value) -> str:
    return ("yes" if value else "no") if isinstance(value, bool) else shown(value)


def _words(text: str | Sentence, style: str = "") -> Text:
    """A text of a snapshot, perhaps of another program: without markup and codes that a terminal obeys."""
    return Text(plain(str(text), LONGEST), style=style)


def _size(console: Console) -> int:
    """The size of the regular file that the console writes to, bytes; 0 if it is none."""
    try:
        status = os.fstat(console.file.fileno())
    except (OSError, ValueError):  # closed, or no file at all
        return 0
    return status.st_size if stat.S_ISREG(status.st_mode) else 0


def _zones(zones: list[dict[str, Any]]) -> Table:
    """The table of the shared zones: the robot in each, and those that wait for it."""
    drawn = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for heading in ("zone", "state", "robot", "waiting"):
        drawn.add_column(heading)
    for each in zones:
        style = {"free": "dim", "quarantined": "red"}.get(each["state"], "")
        words = (each["zone"], each["state"], each["robot"] or "", ", ".join(each["waiting"]))
        drawn.add_row(*(_words(word, style) for word in words))
    return drawn


def _row(cell: dict[str, Any], robots: dict[str, dict[str, Any]], *, by_role: bool) -> list[Text]:
    """The row of a cell; with `told`, the positions of its robots, too."""
    task = cell["task"]
    standing = view.standing(cell)
    style = STANDING.get(standing, "red")
    tasks = [task["text"].removeprefix(f"{cell['name']} ")] if task else []
    tasks += [f"+{len(cell['queue'])}"] if cell["queue"] else []
    words = (cell["name"], view.standing_said(cell), " ".join(tasks), cell["step"] or "")
    return [
        *(_words(word, style) for word in words),
        *(_of(robots[device["name"]], device["holds"]) for device in (cell["devices"] if by_role else ())),
        Text(f"{task['elapsed_s']:.1f} s" if task else "", style=style),
    ]


def _of(robot: dict[str, Any], holds: str | None) -> Text:
    """The position of a robot and the state of its effector, dim if it is no longer heard."""
    texts = place(robot) or ["?"]
    texts += [fact(holds, robot["facts"][holds])] if holds else []
    return Text(", ".join(texts), style="" if robot["online"] else "dim")


def _question(robot: dict[str, Any]) -> list[str]:
    """The question to a person, then the command of each answer; empty if there is none."""
    question = robot["question"]
    if question is None:
        return []
    line = f"{robot['name']} is asked, {question['left_s']:.0f} s left: {question['text']}"
    return [line, *(f"  {_command(robot['name'], question['id'], answer)}" for answer in question["answers"])]


def _answers(cell: dict[str, Any]) -> list[str]:
    """The last answers to the task of a cell."""
    answers = (cell["task"] or {}).get("answers", [])[-MOST_ANSWERS:]
    return [f"{cell['name']} heard: {heard(answers)}"] if answers else []


def heard(answers: Iterable[Mapping[str, Any]]) -> str:
    """The answers in one line: for each the one who gave it, the question and the answer."""
    return "; ".join(f"{each['by']}, {each['asked']}: {answered(each['answer'])}" for each in answers)


def _command(person: str, question: str, answer: str) -> str:
    """The command to type for this question and no later one; `--` protects an answer like an option."""
    dashes = ["--"] if answer.startswith("-") else []
    return shlex.join(["arboleda", "answer", "--question", question, *dashes, person, answer])


def _in_the_way(snapshot: dict[str, Any]) -> list[str]:
    held = [why for cell in snapshot["cells"] if (why := _why(cell))]
    latched = [each["name"] for each in snapshot["robots"] if each.get("latched")]
    stopped = [f"stop (software) latched: {', '.join(latched)}; clear, then reset"] if latched else []
    return held + stopped + _obstacles(snapshot)


def _why(cell: dict[str, Any]) -> str | None:
    """The obstacle of a cell and its remedy; a latch is reported for all robots together."""
    if cell["state"] == CellState.STOPPED and cell["advice"]:
        return f"{cell['name']} is {cell['state']}; {cell['advice'][0]['said']}"
    return cell["held_by"] or cell["not_ready"] or _to_do_by_hand(cell)


def _to_do_by_hand(cell: dict[str, Any]) -> str | None:
    """The first advice to a person at a cell that takes tasks all the same."""
    first = next(iter(cell["advice"]), None)
    return f"{cell['name']}: {first['said']}" if first is not None and first["hand"] else None


def _obstacles(snapshot: dict[str, Any]) -> list[str]:
    """The obstacles of robots without a task. A latch alone is reported in one line for all robots, and an
    obstacle that its idle cell reports is left out."""
    blocking = {cell["blocked_by"] for cell in snapshot["cells"]}
    idle = {each["name"] for cell in snapshot["cells"] if not cell["task"] for each in cell["devices"]}
    robots = [each for each in snapshot["robots"] if each["name"] in idle and each["obstacle"]]
    robots = [each for each in robots if each["name"] not in blocking]
    return [each["obstacle"] for each in robots if not (each["online"] and each.get("latched"))]


def joints(robot: dict[str, Any]) -> str:
    """Joint positions for a person: degrees, then millimetres."""
    values = list(zip(robot["q"], robot["units"], strict=True))
    turns = " ".join(f"{math.degrees(value):.0f}" for value, unit in values if unit == "rad")
    slides = " ".join(f"{value * 1000:.0f} mm" for value, unit in values if unit == "m")
    return " ".join(filter(None, (turns and f"{turns}°", slides)))


def parting(snapshot: dict[str, Any]) -> list[str]:
    """The last state of each robot that was ever heard, and the tasks that go on at the next start."""
    holds = {each["name"]: each["holds"] for cell in snapshot["cells"] for each in cell["devices"]}
    people = {each["name"] for _, each in view.devices_once(snapshot["cells"]) if each["asked"]}
    robots = [robot for robot in snapshot["robots"] if robot["name"] not in people]
    heard = [robot for robot in robots if robot["age_s"] is not None]
    left = [_left(robot, holds[robot["name"]]) for robot in heard]
    tasks = [cell for cell in snapshot["cells"] if cell["task"] is not None and snapshot["ending"]]
    return left + [f"{cell['name']}: {cell['task']['text']} is left for the next start" for cell in tasks]


def _left(robot: dict[str, Any], holds: str | None) -> str:
    held = robot["facts"][holds] if holds else None
    grip = f", {holds} {fact(holds, held)}" if holds and held is not None else ""
    if not robot["online"]:
        return f"{robot['name']}: offline, not known to be still{grip}"
    still = robot["state"] in (MotionState.STOPPED, MotionState.NOT_HOMED, MotionState.STOP_LATCHED)
    return f"{robot['name']}: {'still' if still else 'NOT confirmed still'}{grip}"


def summary(results: dict[str, TaskChanged], seconds: dict[str, float]) -> Table:
    """The table of outcomes of the tasks, in the order they were asked for; keys are task ids."""
    drawn = Table(title="summary", title_justify="left")
    for heading in ("task", "outcome", "time", "reason"):
        drawn.add_column(heading)
    for task, change in results.items():
        took = f"{seconds[task]:.1f} s" if task in seconds else ""
        outcome = Text(change.state.value, style=STYLES[change.state])
        drawn.add_row(_words(change.text), outcome, took, _words(change.sentence))
    return drawn
