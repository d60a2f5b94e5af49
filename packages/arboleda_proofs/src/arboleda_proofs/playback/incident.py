"""Facts of one failed task, collected while its record is executed again."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from operator import attrgetter
from typing import Any

from arboleda.drivers import Command, MotionState, Report, Stop, Switch
from arboleda.drivers import Evidence as Level
from arboleda.engine import Plant
from arboleda.extension import Sentence
from arboleda.model.messages import (
    Event,
    Failure,
    FaultByHand,
    Interference,
    OperatorRequest,
    TaskChanged,
    TaskState,
)
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.verbs import as_text
from arboleda.recipes.decorators import first_cause
from arboleda.recorder.chapter import Chapter
from arboleda.recorder.reader import Record
from arboleda.views import tree_view, twin_view

from .cause import BY_KEY, Cause, Evidence, TaskCommand, cause_of
from .chapters import chapters_of
from .troubles import Trouble, Troubles

FRAMES_S, FRAME_S = 10.0, 0.2  # span and interval of the places of devices kept
MESSAGES = 14  # of each device
AFTER_S = 20.0  # time for which a task is followed after its end
AWAY_S = 0.9  # a plant steps at least with each heartbeat; boards stop by themselves a little later
ENDED = frozenset({TaskState.DONE, TaskState.FAILED, TaskState.CANCELLED})
WHOSE = ("robot", "arm", "device")  # slots of sentences that name the device concerned
Row = dict[str, Any]


@dataclass
class Incident:
    """Failed task as the record has it; times in s of the plant's clock. `frames` are places of devices."""

    task: str
    text: str = ""
    cell: str = ""
    began_at: float = 0.0
    failed_at: float | None = None
    ended_at: float | None = None
    unix_ns: int = 0  # time of its end
    state: TaskState | None = None
    failure: Failure | None = None
    tree: list[Row] = field(default_factory=list)
    frames: list[tuple[float, list[Row]]] = field(default_factory=list)
    messages: dict[str, list[tuple[float, str]]] = field(default_factory=dict)
    acts: list[tuple[float, str]] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)
    sent: dict[str, TaskCommand] = field(default_factory=dict)
    absences: list[tuple[float, float]] = field(default_factory=list)
    foreign: list[tuple[float, str]] = field(default_factory=list)
    provoked: list[tuple[float, str, Sentence]] = field(default_factory=list)
    chapters: list[Chapter] = field(default_factory=list)  # of packages

    def take_chapters(self, record: Record, *, later: bool) -> None:
        """Take in what packages wrote about the task, in its record and, if wanted, in `later` ones."""
        self.chapters = chapters_of(record, self.task, later=later)

    @property
    def evidence(self) -> Evidence:
        """The facts for the rules of causes; call it only for a task that has failed."""
        assert self.failure is not None and self.failed_at is not None
        parts = list(first_cause(self.failure.sentence).parts())
        values = {slot: value for part in reversed(parts) for slot, value in part.values.items()}
        how = values.get("how")
        robot = next((str(values[slot]) for slot in WHOSE if slot in values), None)
        doing = values.get("doing", "")
        return Evidence(
            reason=self.failure.reason,
            key=next((part.key for part in parts if part.key in BY_KEY), parts[0].key),
            failed_at=self.failed_at,
            robot=robot,
            doing=doing if isinstance(doing, Sentence) else str(doing),
            word=str(values.get("word", "")),
            inner=how.key if isinstance(how, Sentence) else "",
            sent=[each for each in self.sent.values() if each.at < self.failed_at],
            troubles=self.troubles,
            acts=self.acts,
            absences=self.absences,
            foreign=self.foreign,
            provoked=self.provoked,
            sentence=self.failure.sentence,
        )

    @property
    def cause(self) -> Cause:
        return cause_of(self.evidence)


class Reader:
    """Observer of a plant that is executed again, for one task; `at_once` has all that it needs of a step.

    `drawn`: the places of devices and the tree are wanted, too.
    """

    def __init__(self, task: str, model: PlantModel, *, drawn: bool = True) -> None:
        self.incident = Incident(task)
        self._drawn = drawn
        self._troubles = Troubles(supervised(model), model.timing.stale_after_s)
        self._last: dict[str, deque[tuple[float, str]]] = {
            name: deque(maxlen=MESSAGES) for name in model.robots
        }
        self._words: dict[str, object] = {}
        self._accepted: dict[str, str] = {}
        self._stepped_at: float | None = None
        self._tree: list[Row] = []
        self._frames: deque[tuple[float, list[Row]]] = deque(maxlen=round(FRAMES_S / FRAME_S))

    @property
    def over(self) -> bool:
        """True once the task has ended and AFTER_S more have been read, within which a reboot would show."""
        ended_at = self.incident.ended_at
        return ended_at is not None and self._stepped_at is not None and self._stepped_at > ended_at + AFTER_S

    def take(
        self, plant: Plant, unix_ns: int, now: float, events: Iterable[Event], messages: Iterable[Any]
    ) -> None:
        """Take in a step that was just made."""
        if self._stepped_at is not None and now - self._stepped_at > AWAY_S:
            self.incident.absences.append((now, now - self._stepped_at))
        self._stepped_at = now
        for event in events:
            self._hear(event, plant.epoch)
        for message in messages:
            self._send(message, unix_ns, now)
        self._look(plant, now)
        if self.incident.ended_at is not None:
            self.incident.troubles = self._troubles.of(now)

    def _hear(self, event: Event, epoch: int) -> None:
        found = self.incident
        self._troubles.take([event])
        if isinstance(event, Report):
            self._report(event)
            if self._took_from_another(event, epoch):
                found.foreign.append((event.at, event.robot))
        elif isinstance(event, OperatorRequest):
            found.acts.append((event.at, _in_words(event)))
        elif isinstance(event, FaultByHand) and not event.is_over:
            found.provoked.append((event.at, event.robot, event.sentence))
        elif isinstance(event, Interference):
            found.foreign.append((event.at, event.robot))

    def _report(self, report: Report) -> None:
        found = self.incident
        sent = found.sent.get(report.accepted or "")
        if sent is not None:
            found.sent[sent.id] = _after(sent, report)
        words = news_of(report)
        if report.robot in self._last and self._words.get(report.robot) != words:
            self._words[report.robot] = words
            self._last[report.robot].append((report.at, report_text(report)))
        if report.foreign is not None and report.foreign_obeyed:
            found.foreign.append((report.at, report.robot))

    def _took_from_another(self, report: Report, epoch: int) -> bool:
        """True if the robot has just taken a command whose id is of another start of a plant."""
        now, before = report.accepted, self._accepted.get(report.robot)
        if now is None or now == before:
            return False
        self._accepted[report.robot] = now
        return before is not None and not now.startswith(f"{epoch}-")

    def _send(self, message: Any, unix_ns: int, now: float) -> None:
        found = self.incident
        if isinstance(message, Command) and not isinstance(message, Stop):
            switch = isinstance(message, Switch)
            found.sent[message.id] = TaskCommand(id=message.id, robot=message.robot, at=now, switch=switch)
            fields = " ".join(
                f"{key}={_short(value)}" for key, value in message.given.items() if key != "robot"
            )
            self._last[message.robot].append((now, f"> {type(message).__name__} {fields} (id {message.id})"))
        elif isinstance(message, TaskChanged) and message.task == found.task:
            self._change(message, unix_ns, now)

    def _change(self, change: TaskChanged, unix_ns: int, now: float) -> None:
        found = self.incident
        if found.state is None:
            found.text, found.cell, found.began_at = change.text, change.cell or "", now
        found.state = change.state
        if change.state in ENDED:
            found.ended_at, found.unix_ns = now, unix_ns
        if change.state in ENDED and change.reason is not None and found.failure is None:
            found.failure = Failure(reason=change.reason, sentence=change.sentence)
            found.failed_at = now

    def _look(self, plant: Plant, now: float) -> None:
        """Note the state around the failure: its time, the tree just before it, and the places up to it."""
        found = self.incident
        run = plant.cells.get(found.cell)
        if run is None:
            return
        if self._drawn and (not self._frames or now - self._frames[-1][0] >= FRAME_S):
            self._frames.append((now, twin_view.positions(plant)["robots"]))
        if run.task is None or run.task.id != found.task:
            self._keep()
            return
        failure = run.task.failure or run.context.failures.first
        if failure is None:  # perhaps another attempt: an earlier failure no longer counts
            found.failure = found.failed_at = None
            if self._drawn and run.tree is not None:
                self._tree = tree_view.rows(run.tree, now)
            found.frames = []
        elif found.failed_at is None:
            found.failure, found.failed_at = failure, now
            self._keep()

    def _keep(self) -> None:
        """Keep the drawings of the failure: the tree just before it, the places, and the last messages."""
        found = self.incident
        if self._drawn and found.failed_at is not None and not found.frames:
            found.tree = self._tree
            found.frames = [*self._frames]
            found.messages = {name: [*messages] for name, messages in self._last.items() if messages}


def _after(sent: TaskCommand, report: Report) -> TaskCommand:
    """The command after a report of its robot, which has taken it: moving, or at rest without an end."""
    moves = report.state is MotionState.MOVING
    stands = sent.moved and report.state is MotionState.STOPPED and report.done != sent.id
    if sent.accepted_at is not None and (moves, stands) == (sent.moved and not sent.stands, sent.stands):
        return sent
    accepted_at = report.at if sent.accepted_at is None else sent.accepted_at
    return replace(sent, accepted_at=accepted_at, moved=sent.moved or moves, stands=stands)


def supervised(model: PlantModel) -> frozenset[str]:
    """The names of the robots whose silence is a sign of trouble."""
    silent = (Link.SCREEN, Link.NONE)
    robots = model.robots.values()
    return frozenset(
        each.name for each in robots if each.evidence is not Level.STATE and each.link not in silent
    )


def _in_words(request: OperatorRequest) -> str:
    """An operator's act as a person writes it."""
    return f"{request.verb.value} {as_text(request.verb, request.scope, request.arguments)}".strip()


NEWS = ("state", "accepted", "done", "rejected", "failed", "answered", "node", "homed", "effector", "piece")
FIELDS = (*NEWS, "refusal", "failure", "answer", "q", "facts", "boot_id")
news_of = attrgetter(*NEWS, "facts", "boot_id")


def report_text(report: Report) -> str:
    """The fields of a report as text."""
    values = {name: getattr(report, name) for name in FIELDS}
    return " ".join(f"{name}={_short(value)}" for name, value in values.items() if value is not None)


def _short(value: Any) -> str:
    if isinstance(value, tuple | list):
        return "[" + ", ".join(map(_short, value)) + "]"
    if hasattr(value, "name") and hasattr(value, "value"):
        return str(value.name)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
