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

from arboleda.model.cell_states import CellState
from arboleda.model.facts import Value, shown
from arboleda.model.messages import MotionState, TaskChanged, TaskState, Verb
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence
from arboleda.views import view
from arboleda.views.alarms import OF_PACKAGE

from .language import say, word

REFRESH_HZ = 5
LONGEST = 1000  # characters of one text
OUTPUT_BYTES = 10_000_000  # of the file that standard output goes to; it goes on once the file is emptied
EFFECTOR = "effector"
SWITCHED = {  # as an effector is, where other facts are so or not
    True: Phrase("cli.status.on", "on"),
    False: Phrase("cli.status.off", "off"),
}
TRUE = {True: Phrase("cli.status.yes", "yes"), False: Phrase("cli.status.no", "no")}
MOST_ANSWERS = 3  # of a task that runs
ROLES = 3  # so many columns of robots a row of a cell may have; more are told below, a row for each
STATES = {
    None: Phrase("cli.status.unknown", "?"),
    MotionState.STOPPED: Phrase("cli.status.still", "still"),
    MotionState.MOVING: Phrase("cli.status.at_work", "at work"),
    MotionState.FAULT: Phrase("cli.status.fault", "fault"),
    MotionState.NOT_HOMED: Phrase("cli.status.not_homed", "not homed"),
    MotionState.STOP_LATCHED: Phrase("cli.status.latched", "latched"),
    MotionState.NO_LINK: Phrase("cli.status.no_link", "no link"),
}
OFFLINE = Phrase("cli.status.offline", "offline")
PLANT = Phrase("cli.status.plant", "plant {name}")
CELL = Phrase("cli.status.cell", "cell")
STATE = Phrase("cli.status.state", "state")
TASK = Phrase("cli.status.task", "task")
STEP = Phrase("cli.status.step", "step")
TIME = Phrase("cli.status.time", "time")
DEVICE = Phrase("cli.status.device", "device")
KIND = Phrase("cli.status.kind", "kind")
SAYS = Phrase("cli.status.says", "says")
LAST_COMMAND = Phrase("cli.status.last_command", "last command")
ZONE = Phrase("cli.status.zone", "zone")
ROBOT = Phrase("cli.status.robot", "robot")
WAITING = Phrase("cli.status.waiting", "waiting")
HELD_BY = Phrase("cli.status.held_by", "held by {cell}")
NODE = Phrase("cli.status.node", "node {node}")
IS_ASKED = Phrase("cli.status.is_asked", "{person} is asked, {seconds} s left: {question}")
PACKAGE_ASKS = Phrase("cli.status.package_asks", "{package} asks: {question}")
HEARD = Phrase("cli.status.heard", "{cell} heard: {answers}")
LATCHED = Phrase("cli.status.stop_latched", "stop (software) latched: {robots}; clear, then reset")
STANDS = Phrase("cli.status.stands", "{cell} is {state}; {advice}")
TO_DO = Phrase("cli.status.to_do", "{cell}: {advice}")
FULL = Phrase("cli.log.full", "this file has {megabytes} MB and gets no more lines; they go on in {file}")
LEFT_OVER = Phrase("cli.parting.left_over", "{cell}: {task} is left for the next start")
LEFT_OFFLINE = Phrase("cli.parting.offline", "{robot}: offline, not known to be still{grip}")
LEFT_STILL = Phrase("cli.parting.still", "{robot}: still{grip}")
LEFT_MOVING = Phrase("cli.parting.moving", "{robot}: NOT confirmed still{grip}")
SUMMARY = Phrase("cli.summary", "summary")
OUTCOME = Phrase("cli.summary.outcome", "outcome")
REASON = Phrase("cli.summary.reason", "reason")
SHORT = (CELL, STATE, TASK, TIME)  # columns that take one line, however narrow the terminal is
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
        self._question_ids: dict[str, str | None] = {}

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
            full = FULL(megabytes=OUTPUT_BYTES // 1_000_000, file=str(self._log_file))
            self.console.print(Text(say(full)))
        return self._full

    def stepped(self, snapshot: dict[str, Any], at: float) -> None:
        """Without a terminal, print a line per step, and the questions to people, in place of the table."""
        if self.console.is_terminal:
            return
        for cell in snapshot["cells"]:
            if cell["state"] == CellState.HELD:
                continue  # its step goes on once a person says so
            if cell["step"] != self._steps.get(cell["name"]) and cell["step"] is not None:
                self.say(_words(f"  {cell['name']}: {say(cell['step'])}"), at)
            self._steps[cell["name"]] = cell["step"]
        for robot in snapshot["robots"]:
            question_id = robot["question"] and robot["question"]["id"]
            if question_id != self._question_ids.get(robot["name"]):
                for line in _question(robot):
                    self.say(_words(line), at)
            self._question_ids[robot["name"]] = question_id
        for asked in snapshot.get("questions", ()):
            if asked["id"] not in self._question_ids:
                self._question_ids[asked["id"]] = asked["id"]
                for line in _asks(asked):
                    self.say(_words(line), at)


def logged(line: logging.LogRecord) -> Text:
    """A line of the log in its colours; the change of a task has those of its state."""
    change = getattr(line, "change", None)
    if change is None:
        style = "dim" if line.levelno < logging.WARNING else "yellow"
        sentence = getattr(line, "sentence", None)
        message = line.getMessage() if sentence is None else plain(say(sentence), LONGEST)
        return Text(message, style="red" if line.levelno >= logging.ERROR else style)
    text = Text(_of_task(change))
    text.stylize(STYLES[change.state], 0, STATE_WIDTH)
    text.stylize("bold", STATE_WIDTH + 1, STATE_WIDTH + 1 + len(change.text))
    return text


def _of_task(change: TaskChanged) -> str:
    """The line on a change of a task."""
    why = f"  {say(change.sentence)}" if change.sentence else ""
    cause = f" ({word('reason', change.reason.value)})" if change.reason else ""
    state = word("task_state", change.state.value)
    return plain(f"{state:<{STATE_WIDTH}} {change.text}{why}{cause}", LONGEST)


def table(snapshot: dict[str, Any]) -> Group:
    """The table with a row per cell: state, task, step, robots, time; below it other devices, zones,
    questions to people, answers to the tasks that run, and obstacles."""
    robots = {robot["name"]: robot for robot in snapshot["robots"]}
    columns = _columns(snapshot["cells"])
    headings = [*map(_text, (CELL, STATE, TASK, STEP)), *columns, _text(TIME)]
    title = _words(PLANT(name=snapshot["plant"]), "italic")
    drawn = _table(headings, title=title, title_justify="left")
    for cell in snapshot["cells"]:
        drawn.add_row(*_row(cell, robots, by_role=bool(columns)))
    others = [] if columns else [_devices(snapshot["cells"], robots)]
    zones = [_zones(snapshot["zones"])] if snapshot.get("zones") else []
    questions = [_words(line, "cyan") for robot in snapshot["robots"] for line in _question(robot)]
    questions += [_words(line, "cyan") for each in snapshot.get("questions", ()) for line in _asks(each)]
    answers = [_words(line) for cell in snapshot["cells"] for line in _answers(cell)]
    troubles = [_words(line, "yellow") for line in _in_the_way(snapshot)]
    alarms = [_words(line, "yellow") for line in _alarms(snapshot)]
    return Group(drawn, *others, *zones, *questions, *answers, *troubles, *alarms)


def _table(headings: list[str], **settings: Any) -> Table:
    drawn = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0), **settings)
    short = {_text(each) for each in SHORT}
    for heading in headings:
        drawn.add_column(heading, no_wrap=heading in short)
    return drawn


def _text(phrase: Phrase) -> str:
    return say(phrase())


def _columns(cells: list[dict[str, Any]]) -> list[str]:
    """The heading of each role, if every cell has the same few roles for robots that go somewhere."""
    headings = {tuple(_heading(device) for device in cell["devices"]) for cell in cells}
    moving = all(device["position"] for cell in cells for device in cell["devices"])
    return list(*headings) if len(headings) == 1 and moving and len(*headings) <= ROLES else []


def _heading(device: dict[str, Any]) -> str:
    words = (word("device_kind", device["role"]), word("fact", device["holds"] or ""))
    return ", ".join(filter(None, words))


def _devices(cells: list[dict[str, Any]], robots: dict[str, dict[str, Any]]) -> Table:
    """The table of the devices: state, facts and last command of each."""
    drawn = _table([*map(_text, (CELL, DEVICE, KIND, STATE, SAYS, LAST_COMMAND))])
    for _, device in view.devices_once(cells):
        name = device["name"]
        robot = robots[name]
        state = _text(STATES[robot["state"]] if robot["online"] else OFFLINE)
        having = [cell["name"] for cell in cells if any(each["name"] == name for each in cell["devices"])]
        held = [say(HELD_BY(cell=robot["holder"]))] if robot.get("holder") else []
        words = (
            ", ".join(having),
            name,
            word("device_kind", device["kind"]),
            state,
            ", ".join(filter(None, [says(robot), *held])),
            _last_command(robot),
        )
        drawn.add_row(*(_words(word, "" if robot["online"] else "dim") for word in words))
    return drawn


def _last_command(robot: dict[str, Any]) -> str:
    command, answer = robot["command"], robot["answer"]
    if command is None:
        return ""
    line = f"{say(command['what'])}: {word('command_state', command['state'])}"
    return line if answer is None else f"{line}, {answered(answer)}"


def says(robot: dict[str, Any]) -> str:
    """The position of a robot, and each of its facts by name."""
    facts = [f"{word('fact', name)} {fact(name, value)}" for name, value in robot["facts"].items()]
    return ", ".join([*place(robot), *facts])


def place(robot: dict[str, Any]) -> list[str]:
    """The reported position of a robot; empty if it reports none."""
    if robot["q"] is not None:
        return [joints(robot)]
    return [] if robot["node"] is None else [say(NODE(node=robot["node"]))]


def fact(name: str, value: Value | None) -> str:
    """A fact for a person; `?` if it was not reported yet."""
    if value is None:
        return "?"
    return _text(SWITCHED[value]) if name == EFFECTOR and isinstance(value, bool) else answered(value)


def answered(value: Value) -> str:
    return _text(TRUE[value]) if isinstance(value, bool) else shown(value)


def _words(text: str | Sentence, style: str = "") -> Text:
    """A text of a snapshot, perhaps of another program: without markup and codes that a terminal obeys."""
    return Text(plain(say(text), LONGEST), style=style)


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
    for heading in (ZONE, STATE, ROBOT, WAITING):
        drawn.add_column(_text(heading))
    for each in zones:
        style = {"free": "dim", "quarantined": "red"}.get(each["state"], "")
        words = (
            each["zone"],
            word("zone_state", each["state"]),
            each["robot"] or "",
            ", ".join(each["waiting"]),
        )
        drawn.add_row(*(_words(word, style) for word in words))
    return drawn


def _row(cell: dict[str, Any], robots: dict[str, dict[str, Any]], *, by_role: bool) -> list[Text]:
    """The row of a cell; with `told`, the positions of its robots, too."""
    task = cell["task"]
    standing = view.standing(cell)
    style = STANDING.get(standing, "red")
    tasks = [task["text"].removeprefix(f"{cell['name']} ")] if task else []
    tasks += [f"+{len(cell['queue'])}"] if cell["queue"] else []
    words = (cell["name"], _standing(cell), " ".join(tasks), cell["step"] or "")
    return [
        *(_words(word, style) for word in words),
        *(_of(robots[device["name"]], device["holds"]) for device in (cell["devices"] if by_role else ())),
        Text(f"{task['elapsed_s']:.1f} s" if task else "", style=style),
    ]


def _standing(cell: dict[str, Any]) -> str:
    """The word for a cell's state, and for an idle cell that cannot work."""
    state, stands = str(cell["state"]), view.standing(cell)
    known = word("cell_state", state if stands == state else stands)
    return view.standing_text(cell) if known in (state, stands) else known


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
    left = f"{question['left_s']:.0f}"
    line = IS_ASKED(person=robot["name"], seconds=left, question=question["text"])
    return [
        say(line),
        *(f"  {_command(robot['name'], question['id'], answer)}" for answer in question["answers"]),
    ]


def _asks(question: dict[str, Any]) -> list[str]:
    """The question of a package, and its answers as commands."""
    package = question["package"]
    return [
        say(PACKAGE_ASKS(package=package, question=question["text"])),
        *(f"  {_command(package, question['id'], answer)}" for answer in question["answers"]),
    ]


def _answers(cell: dict[str, Any]) -> list[str]:
    """The last answers to the task of a cell."""
    answers = (cell["task"] or {}).get("answers", [])[-MOST_ANSWERS:]
    return [say(HEARD(cell=cell["name"], answers=answers_line(answers)))] if answers else []


def answers_line(answers: Iterable[Mapping[str, Any]]) -> str:
    """The answers in one line: for each the one who gave it, the question and the answer."""
    return "; ".join(f"{each['by']}, {each['asked']}: {answered(each['answer'])}" for each in answers)


def _command(person: str, question: str, answer: str) -> str:
    """The command to type for this question and no later one; `--` protects an answer like an option."""
    dashes = ["--"] if answer.startswith("-") else []
    return shlex.join(["arboleda", "answer", "--question", question, *dashes, person, answer])


def _in_the_way(snapshot: dict[str, Any]) -> list[Sentence | str]:
    held = [why for cell in snapshot["cells"] if (why := _why(cell))]
    latched = [each["name"] for each in snapshot["robots"] if each.get("latched")]
    stopped = [LATCHED(robots=tuple(latched))] if latched else []
    return [*held, *stopped, *_obstacles(snapshot)]


def _alarms(snapshot: dict[str, Any]) -> list[Sentence]:
    """The alarms of packages; a plant of an earlier version tells of none."""
    alarms = snapshot.get("alarms", ())
    return [OF_PACKAGE(package=each["package"], said=each["sentence"]) for each in alarms]


def _why(cell: dict[str, Any]) -> Sentence | str | None:
    """The obstacle of a cell and its remedy; a latch is reported for all robots together."""
    if cell["state"] == CellState.STOPPED and cell["advice"]:
        return STANDS(
            cell=cell["name"], state=word("cell_state", cell["state"]), advice=cell["advice"][0]["said"]
        )
    return cell["held_by"] or cell["not_ready"] or _to_do(cell)


def _to_do(cell: dict[str, Any]) -> Sentence | None:
    """The first advice on a machine of a cell that takes tasks all the same."""
    first = next(iter(cell["advice"]), None)
    if first is None or not (first["hand"] or first["do"] == Verb.DO):
        return None
    return TO_DO(cell=cell["name"], advice=first["said"])


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
    reporting = [robot for robot in robots if robot["age_s"] is not None]
    left = [_left(robot, holds[robot["name"]]) for robot in reporting]
    tasks = [cell for cell in snapshot["cells"] if cell["task"] is not None and snapshot["ending"]]
    return left + [say(LEFT_OVER(cell=cell["name"], task=cell["task"]["text"])) for cell in tasks]


def _left(robot: dict[str, Any], holds: str | None) -> str:
    held = robot["facts"][holds] if holds else None
    grip = f", {holds} {fact(holds, held)}" if holds and held is not None else ""
    if not robot["online"]:
        return say(LEFT_OFFLINE(robot=robot["name"], grip=grip))
    still = robot["state"] in (MotionState.STOPPED, MotionState.NOT_HOMED, MotionState.STOP_LATCHED)
    return say((LEFT_STILL if still else LEFT_MOVING)(robot=robot["name"], grip=grip))


def summary(results: dict[str, TaskChanged], seconds: dict[str, float]) -> Table:
    """The table of outcomes of the tasks, in the order they were asked for; keys are task ids."""
    drawn = Table(title=_text(SUMMARY), title_justify="left")
    for heading in (TASK, OUTCOME, TIME, REASON):
        drawn.add_column(_text(heading))
    for task, change in results.items():
        took = f"{seconds[task]:.1f} s" if task in seconds else ""
        outcome = Text(word("task_state", change.state.value), style=STYLES[change.state])
        drawn.add_row(_words(change.text), outcome, took, _words(change.sentence))
    return drawn
