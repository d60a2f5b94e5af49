"""The case that a simulation gets from a record: collected while the record is executed again."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.model.messages import ENDED, Event, OperatorRequest, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import PlantModel
from arboleda.model.verbs import lasting
from arboleda.recorder.reader import Record
from arboleda_proofs.campaigns.plants import ELSEWHERE
from arboleda_proofs.playback.incident import AWAY_S, Reader, supervised
from arboleda_proofs.playback.replay import plant_of
from arboleda_proofs.playback.troubles import Troubles
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.scripted_people import Act, scopes

from ..recorded_plant import model_of, versions_of
from .faults import faults_behind, faults_of, stall

LEAD_S = 2.0  # from the beginning of a case to the task that it is about: by then the boards are heard
AFTER_S = 1.0  # from the end of that task to the end of the case
FAILED = (TaskState.FAILED, TaskState.CANCELLED)


@dataclass(frozen=True, kw_only=True)
class Case:
    """People and faults; times in s since the case began, which is `unix_ns` of the record."""

    plant: str
    unix_ns: int
    seconds: float
    people: list[Act]
    faults: list[Fault]


@dataclass
class _CaseEvents:
    """Acts, causes and stalls found so far; times of the plant's clock."""

    model: PlantModel
    acts: list[Act] = field(default_factory=list)
    causes: list[Fault] = field(default_factory=list)
    stalls: list[Fault] = field(default_factory=list)
    open: dict[str, Act] = field(default_factory=dict)  # tasks that were accepted and have not ended, by id
    running: set[str] = field(default_factory=set)
    readers: dict[str, Reader] = field(default_factory=dict)
    ids: set[str] = field(default_factory=set)

    def change(self, change: TaskChanged, now: float) -> None:
        """Follow a change of a task; a repeated request for a known task changes nothing."""
        id = change.task
        if id not in self.ids:
            self.ids.add(id)
            self.open[id] = Act(at=now, task=f"{change.text} #{_own(id)}")
            self.acts.append(self.open[id])
            self.readers[id] = Reader(id, self.model, drawn=False)
        if change.state is TaskState.RUNNING:
            self.running.add(id)
        elif change.state in ENDED:
            self.running.discard(id)
            self.open.pop(id, None)

    def act(self, event: OperatorRequest) -> None:
        """Note an operator's act; one whose scope is unknown to this plant was refused, and is left out."""
        scope, by_hand = _scope(event), event.by_hand
        first = scope.partition(" ")[0]
        if not first or first in scopes(self.model) or first in {_own(id) for id in self.ids}:
            taken = lasting(event.verb, event.arguments)
            self.acts.append(Act(at=event.at, verb=event.verb, scope=scope, by_hand=by_hand, arguments=taken))


def case_of(record: Record, task: str | None) -> Case:
    """The case of a whole record, or of one task from its beginning to its end; ConfigError, NoRecord."""
    return _Making(record, task).case()


class _Making:
    def __init__(self, record: Record, task: str | None) -> None:
        self._record = record
        self._beginning = record.first.beginning
        self._plant = plant_of(self._beginning, model_of(self._beginning), versions_of(record))
        model = self._plant.model
        self._task = task
        self._found = _CaseEvents(model.on_boards(*ELSEWHERE))
        self._troubles = Troubles(supervised(model), model.timing.stale_after_s)
        self._from: tuple[float, list[Act]] | None = (
            None  # the beginning of the task, and the tasks at work then
        )
        self._until: float | None = None
        self._now = self._beginning.now
        self._unix_ns = record.first.began_ns

    def case(self) -> Case:
        for step in self._record.steps():
            if step.now - self._now > AWAY_S:
                self._found.stalls.append(stall(step.now, step.now - self._now))
            self._now, self._unix_ns = step.now, step.unix_ns
            self._take(step.unix_ns, step.events)
            if self._until is not None and self._task not in self._found.readers:
                break
        if self._task is not None and self._from is None:
            raise ConfigError((f"{plain(self._task, 80)}: it did not begin in this record",))
        for reader in self._found.readers.values():
            self._judge(reader)
        return self._cut()

    def _take(self, unix_ns: int, events: Iterable[Event]) -> None:
        found, now = self._found, self._now
        messages = self._plant.step(now, events)
        self._troubles.take(events)
        for event in events:
            if isinstance(event, OperatorRequest):
                found.act(event)
        for message in messages:
            if isinstance(message, TaskChanged) and message.task and self._until is None:
                found.change(message, now)
                self._mind(message)
        for id, reader in [*found.readers.items()]:
            reader.take(self._plant, unix_ns, now, events, messages)
            if reader.over or reader.incident.state is TaskState.DONE:
                self._judge(found.readers.pop(id))

    def _mind(self, change: TaskChanged) -> None:
        """Note the beginning and the end of the task that the case is about."""
        if change.task != self._task:
            return
        if change.state is TaskState.RUNNING and self._from is None:
            self._from = (self._now, self._at_work(change.task))
        elif change.state in ENDED and self._from is not None:
            self._until = self._now

    def _at_work(self, task: str) -> list[Act]:
        """The tasks that are open now, in the order in which they would begin once more: this task first."""
        found = self._found
        order = sorted(found.open, key=lambda id: (id != task, id not in found.running))
        return [found.open[id] for id in order]

    def _judge(self, reader: Reader) -> None:
        incident = reader.incident
        if incident.state in FAILED and incident.failure is not None and incident.failed_at is not None:
            cause = incident.cause
            if cause.kind != "plant_away":  # an absent plant concerns all tasks
                self._found.causes += faults_behind(incident, cause, self._found.model)

    def _cut(self) -> Case:
        """The wanted part of the record, with times from its own beginning."""
        found = self._found
        began, ends = self._beginning.now, self._now
        acts = found.acts
        if self._from is not None:
            began, ends = self._from[0] - LEAD_S, (self._until or self._now) + AFTER_S
            later = [act for act in acts if self._from[0] < act.at <= ends]
            acts = [replace(act, at=self._from[0]) for act in self._from[1]] + later
        faults = [*faults_of(self._troubles.of(self._now), found.model), *found.causes, *found.stalls]
        within = [fault for fault in faults if began - fault.seconds <= fault.at <= ends]
        unix_ns = self._unix_ns - round((self._now - began) * 1e9)
        return Case(
            plant=self._found.model.name,
            unix_ns=unix_ns,
            seconds=round(ends - began, 3),
            people=[replace(act, at=round(act.at - began, 3)) for act in acts],
            faults=list(_from(sorted(dict.fromkeys(within), key=_at), began, ends)),
        )


def _at(fault: Fault) -> float:
    return fault.at


def _from(faults: Iterable[Fault], began: float, ends: float) -> Iterator[Fault]:
    """The faults with times from `began`; earlier ones go on, those without an end last to `ends`."""
    for fault in faults:
        at = max(0.0, fault.at - began)
        last = ends - began if fault.seconds == math.inf else fault.at + fault.seconds - began
        seconds = max(0.0, last - at) if fault.seconds else 0.0
        yield replace(fault, at=round(at, 3), seconds=round(seconds, 3), amount=round(fault.amount, 3))


def _own(id: str) -> str:
    """The id of a task without the t- that a plant puts before its own, so that a person may use it."""
    return id.removeprefix("t-")


def _scope(request: OperatorRequest) -> str:
    """The scope of an act in another run, which gives its tasks other ids."""
    return _own(request.scope) if request.verb is Verb.CANCEL else request.scope
