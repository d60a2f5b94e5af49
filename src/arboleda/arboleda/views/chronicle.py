"""Time line: events found from snapshot to snapshot."""

from __future__ import annotations

from collections import deque
from collections.abc import Container, Iterable, Iterator
from typing import Any

from arboleda.engine import BY_OPERATOR
from arboleda.model.messages import Outcome
from arboleda.model.sentence import NOTHING, OWN, Phrase, Sentence, as_sentence

from .view import devices_once

TASK_FAILED = Phrase("event.task", "{task}: {why}")
EVENTS = 1000  # kept; older ones are forgotten

Event = dict[str, Any]
Row = dict[str, Any]
PlantNews = tuple["str | None", str, str, str, Sentence]


class Chronicle:
    """Events {number, at (unix s), cell, kind, subject, what, sentence}, the newest last.

    `kind` is task, cell, robot, zone, operator, foreign, fault or alarm; `what` the word of the new state.
    """

    def __init__(self, past_acts: Iterable[Row] = ()) -> None:
        self.events: deque[Event] = deque(maxlen=EVENTS)
        self._count = 0
        self._known: dict[tuple[str, str], str] = {}
        self._last_act = self._last_interference = self._last_fault = 0
        self._answered: deque[int] = deque(maxlen=EVENTS)  # numbers of questions of packages
        self._alarms: dict[int, Row] = {}  # of packages, that stand
        self._awaited: set[int] = set()  # the acts whose end is still to come
        for act in past_acts:
            self._did(act["at"], act)

    def see(self, snapshot: Row, unix_s: float) -> None:
        """Add the news of a snapshot."""
        for act in snapshot["acts"]:
            if act["number"] > self._last_act:
                self._last_act = act["number"]
                self._awaited.add(act["number"])
                self._did(unix_s - (snapshot["at"] - act["at"]), act)
            if act["number"] in self._awaited and act["outcome"] != Outcome.UNDER_WAY:
                self._awaited.discard(act["number"])
                if act["ended"] is not None:
                    self._ended(unix_s - (snapshot["at"] - act["ended_at"]), act)
        self._provoked(snapshot, unix_s)
        self._raised(snapshot, unix_s)
        for act in snapshot.get("answered", ()):  # questions of packages
            if act["number"] not in self._answered:
                self._answered.append(act["number"])
                age_s = snapshot["at"] - act["at"]
                self._did(unix_s - age_s, act)
        news = (*self._interference(snapshot), *_states(snapshot, self._known))
        for cell, kind, subject, what, sentence in news:
            if kind == "foreign" or self._known.get((kind, subject)) != what:
                first = (kind, subject) not in self._known
                self._known[(kind, subject)] = what
                if not (first and what in EXPECTED):
                    self._add(unix_s, cell, kind, subject, what, sentence)

    def _did(self, unix_s: float, act: Row) -> None:
        """Add an operator's act."""
        self._add(
            unix_s, act["cell"], "operator", act["scope"] or "plant", "did", as_sentence(act["sentence"])
        )

    def _ended(self, at: float, act: Row) -> None:
        """Add the outcome of an operator's act."""
        subject = act["scope"] or "plant"
        self._add(at, act["cell"], "operator", subject, act["outcome"], as_sentence(act["ended"]))

    def _provoked(self, snapshot: Row, unix_s: float) -> None:
        """Add the faults that people had happen to virtual devices."""
        cell_of = _cells(snapshot)
        for each in snapshot.get("faults", ()):  # a plant of an earlier version tells of none
            if each["number"] > self._last_fault:
                self._last_fault, robot = each["number"], each["robot"]
                at = unix_s - (snapshot["at"] - each["at"])
                self._add(at, cell_of.get(robot), "fault", robot or "plant", "provoked", each["sentence"])

    def _raised(self, snapshot: Row, unix_s: float) -> None:
        """Add the alarms of packages, and their ends."""
        before, now = self._alarms, {each["id"]: each for each in snapshot.get("alarms", ())}
        self._alarms = now
        for id in sorted(before.keys() ^ now.keys()):
            each, what = (now[id], "raised") if id in now else (before[id], "over")
            sentence = as_sentence(each["sentence"])
            self._add(unix_s, each["cell"] or None, "alarm", each["package"], what, sentence)

    def _interference(self, snapshot: Row) -> Iterator[PlantNews]:
        cell_of = _cells(snapshot)
        for each in snapshot["interference"]:
            if each["number"] > self._last_interference:
                self._last_interference = each["number"]
                yield cell_of.get(each["robot"]), "foreign", each["robot"], "commanded", each["sentence"]

    def _add(
        self, at: float, cell: str | None, kind: str, subject: str, what: str, sentence: Sentence
    ) -> None:
        self._count += 1
        self.events.append(
            {
                "number": self._count,
                "at": at,
                "cell": cell,
                "kind": kind,
                "subject": subject,
                "what": what,
                "sentence": sentence,
            }
        )


EXPECTED = frozenset({"idle", "free", "offline"})  # initial states, which are no events


def _cells(snapshot: Row) -> dict[str, str]:
    """The cell of each robot."""
    return {each["name"]: cell["name"] for cell in snapshot["cells"] for each in cell["devices"]}


def _states(snapshot: Row, known: Container[tuple[str, str]]) -> Iterator[PlantNews]:
    """The state of every cell, task, robot and zone: cell, kind, subject, state, sentence.

    Of a task that is not `known` yet also why it is done in its cell.
    """
    online = {robot["name"]: robot["online"] for robot in snapshot["robots"]}
    for cell in snapshot["cells"]:
        yield cell["name"], "cell", cell["name"], cell["state"], cell["held_by"] or NOTHING
    for of, device in devices_once(snapshot["cells"]):
        name = device["name"]
        yield of, "robot", name, "online" if online[name] else "offline", NOTHING
    for task in snapshot["tasks"]:
        text = f"{task['text']} #{task['id']}"
        is_new = ("task", task["id"]) not in known
        why = task["sentence"] or (is_new and task.get("choice"))
        sentence = TASK_FAILED(task=text, why=why) if why else OWN(text=text)
        yield task["cell"], "task", task["id"], task["state"], sentence
    for zone in snapshot["zones"]:
        yield None, "zone", zone["zone"], zone["state"], OWN(text=zone["robot"] or "")


def is_failure(event: Event) -> bool:
    """True if a task failed, or if a cell was held although no operator wanted it."""
    if event["kind"] == "task":
        return bool(event["what"] == "failed")
    held = event["kind"] == "cell" and event["what"] == "held"
    return held and all(part.key != BY_OPERATOR.key for part in event["sentence"].parts())
