"""Alarms for people who are not looking, as plain data: a failed task, a cell that needs somebody."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import reduce
from typing import Any

from arboleda.engine import AWAY, CellRun, Plant, why_waiting
from arboleda.model.advice import in_words
from arboleda.model.cell_states import CellState
from arboleda.model.commands import Question
from arboleda.model.messages import TaskChanged
from arboleda.model.outside import plain
from arboleda.model.sentence import BOTH, NOTHING, OWN, Phrase, Sentence

from .view import standing, waited_for

Alarm = dict[str, Any]
TASK_FAILED, CELL_HELD, CELL_CLEARED = "task_failed", "cell_held", "cell_cleared"
CELL_BLOCKED, PERSON_ASKED, PLANT_AWAY = "cell_blocked", "person_asked", "plant_away"
MEMORY_SLOW, MEMORY_FAST = "memory_slow", "memory_fast"
PACKAGE_ALARM, PACKAGE_CLEARED = "package_alarm", "package_cleared"
BLOCKED_S = 10.0  # a cell is blocked for so long before its alarm: a board that boots is back by then
NEEDS_SOMEBODY = frozenset({CellState.HELD, CellState.ABORTED, CellState.STOPPED})
AT_WORK_AGAIN = frozenset({CellState.IDLE, CellState.EXECUTE})
ASKED = Phrase("alarm.asked", "{person} is asked in {cell}: {question}")
AWAY_HELD = Phrase("alarm.away", "{why}; what was at work is held: {cells}")
AWAY_GOES_ON = Phrase(
    "alarm.away_goes_on", "{why}; what was at work goes on once its devices prove what they did: {cells}"
)
AWAY_AT_REST = Phrase("alarm.away_at_rest", "{why}; no cell was at work, so that all go on")
CLEARED = Phrase("alarm.cleared", "{cell} needs nobody any more: it is {state}")
OF_PACKAGE = Phrase("alarm.of_package", "{package}: {said}")
OVER = Phrase("alarm.over", "this is over: {said}")
# The longest packet of the plant's own broker has 4096 bytes, and a letter has up to four.
LONGEST, MOST = 300, 6


@dataclass(frozen=True, kw_only=True)
class Need:
    """Reason why a cell needs somebody: the kind of its alarm, and a mark that tells such alarms apart."""

    kind: str
    of: str


class AlarmLevel(str, Enum):
    """Weight of an alarm of a package: a warning is shown, an error is also heard on the page."""

    WARNING = "warning"
    ERROR = "error"


@dataclass(frozen=True, kw_only=True)
class PackageAlarm:
    """Alarm of a package, which stands until the package ends it; `cell` is "" where it is about none.

    `part` is the part of the package that has raised it.
    """

    id: int
    package: str
    sentence: Sentence
    cell: str = ""
    level: AlarmLevel = AlarmLevel.WARNING
    part: str = ""

    @property
    def said(self) -> Sentence:
        """The sentence, with the name of the package before it."""
        return OF_PACKAGE(package=self.package, said=self.sentence)

    def row(self) -> dict[str, Any]:
        """The alarm as plain data."""
        told = {key: each for key, each in vars(self).items() if key != "part"}
        return {**told, "level": self.level.value}


def need_of(run: CellRun) -> Need | None:
    """The reason why a cell needs somebody now; None if it does not."""
    if run.state in NEEDS_SOMEBODY:
        return Need(kind=CELL_HELD, of=run.state.value)
    if questions := _questions(run):
        return Need(kind=PERSON_ASKED, of=" ".join(each.id for each in questions))
    if run.queue and run.not_ready is not None and not run.context.commands.open():
        return Need(kind=CELL_BLOCKED, of="")
    return None


def needs_in(snapshot: dict[str, Any]) -> dict[str, str]:
    """The cells of a snapshot that need somebody: the reason in one word, by name."""
    found = {}
    for cell in snapshot["cells"]:
        stands = standing(cell)
        if cell["state"] in NEEDS_SOMEBODY or (cell["queue"] and stands in ("blocked", "paused")):
            found[cell["name"]] = stands
    return found | dict.fromkeys(waited_for(snapshot), "asked")


def of_task(plant: Plant, failed: TaskChanged) -> Alarm:
    """The alarm for a failed task, with what its cell needs now."""
    reason = failed.reason.value if failed.reason else None
    task = _task(failed.task, failed.text)
    return _alarm(plant, failed.cell or "", TASK_FAILED, task, reason, failed.sentence)


def of_absence(plant: Plant, away_s: float) -> Alarm:
    """The alarm for an absence of the plant: its length, and the cells that it holds or that went on."""
    why = AWAY(seconds=away_s)
    held = {name: run for name, run in plant.cells.items() if run.trouble and run.trouble.sentence == why}
    stay = ", ".join(name for name, run in held.items() if not run.absence.hold)
    go_on = ", ".join(name for name, run in held.items() if run.absence.hold)
    sentence = why if held else AWAY_AT_REST(why=why)
    if go_on:
        sentence = AWAY_GOES_ON(why=sentence, cells=go_on)
    if stay:
        sentence = AWAY_HELD(why=sentence, cells=stay)
    return _alarm(plant, "", PLANT_AWAY, None, None, sentence)


def of_memory(plant: Plant, sentence: Sentence, *, is_slow: bool) -> Alarm:
    """The alarm for slow commits, or its end; it belongs to no cell."""
    return _alarm(plant, "", MEMORY_SLOW if is_slow else MEMORY_FAST, None, None, sentence)


def of_package(plant: Plant, alarm: PackageAlarm, *, over: bool = False) -> Alarm:
    """The alarm of a package, or its end."""
    kind, sentence = (PACKAGE_CLEARED, OVER(said=alarm.said)) if over else (PACKAGE_ALARM, alarm.said)
    told = {"package": alarm.package, "level": alarm.level.value}
    return {**_alarm(plant, alarm.cell, kind, None, None, sentence), **told}


def of_cell(plant: Plant, cell: str) -> Alarm:
    """The alarm for a cell that stands and needs somebody, or its end."""
    run = plant.cells[cell]
    need, first = need_of(run), run.task or next(iter(run.queue), None)
    task = _task(first.id, first.order.text) if first else None
    if need is None:
        return _alarm(plant, cell, CELL_CLEARED, task, None, CLEARED(cell=cell, state=run.state.sentence))
    reason = run.trouble.reason.value if run.trouble and need.kind == CELL_HELD else None
    return _alarm(plant, cell, need.kind, task, reason, _why(run))


def _why(run: CellRun) -> Sentence:
    questions = [
        ASKED(person=each.robot, cell=run.cell.name, question=OWN(text=each.text)) for each in _questions(run)
    ]
    if not questions:
        return why_waiting(run) or NOTHING
    return reduce(lambda first, second: BOTH(first=first, second=second), questions)


def _questions(run: CellRun) -> list[Question]:
    """The open questions to people of the cell, the oldest first."""
    open_ = (entry.command for entry in run.context.commands.open())
    return [each for each in open_ if isinstance(each, Question)]


def _alarm(
    plant: Plant, cell: str, kind: str, task: Alarm | None, reason: str | None, sentence: Sentence
) -> Alarm:
    run = plant.cells.get(cell)  # None where the plant file has it no more
    ways = plant.advice(cell) if run else ()
    return {
        "kind": kind,
        "plant": plant.model.name,
        "cell": cell,
        "state": run.state.value if run else None,
        "task": task,
        "reason": reason,
        "sentence": _short(sentence),
        "advice": [_short(in_words(each)) for each in ways[:MOST]],
    }


def _task(id: str, text: str) -> Alarm:
    return {"id": _short(id), "text": _short(text)}


def _short(value: object) -> str:
    return plain(str(value), LONGEST)
