"""What proves the work, switches and answers of a machine that reports facts instead of a position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import pytest

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.evidence import Before, CommandVerdict, judge
from arboleda.dispatch.ledger import Entry, Feed
from arboleda.model.commands import Command, Motion, Process, Query, Switch
from arboleda.model.facts import Facts, Value
from arboleda.model.messages import MotionState, Reason, Report
from arboleda.model.plant_model import QUIET_S, Evidence, Link, Robot

MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED
ID = "1-1"
DONE = (Feed.DONE, None)


@dataclass(frozen=True, kw_only=True)
class Open(Motion):
    """Opens the door."""

    @property
    def sets(self) -> Facts:
        return (("door", "open"),)


@dataclass(frozen=True, kw_only=True)
class Mill(Process):
    """Runs a program."""

    @property
    def sets(self) -> Facts:
        return (("program", 7),)


@dataclass(frozen=True, kw_only=True)
class Clamp(Switch):
    """Closes the clamp."""

    @property
    def sets(self) -> Facts:
        return (("clamped", True),)


@dataclass(frozen=True, kw_only=True)
class Look(Query):
    """Asks what is there."""


OPENING, MILLING = Open(id=ID, robot="mill"), Mill(id=ID, robot="mill")
CLAMPING, LOOKING = Clamp(id=ID, robot="mill"), Look(id=ID, robot="mill")


def facts(**values: Value) -> Facts:
    return tuple(values.items())


def verdict(command: Command, level: Evidence, *said: dict[str, Any]) -> CommandVerdict | None:
    """The first end that reports half a second apart prove; the machine stood still with its door closed."""
    belief = Belief(Robot(name="mill", mqtt="mill", link=Link.MQTT, evidence=level, timeout_s=5.0), 1.5, 1)
    belief.merge(Report(at=-0.1, robot="mill", state=STOPPED, facts=facts(door="closed", clamped=False)))
    entry = Entry(command, cell="cell", doing="working", sent_at=0.0, deadline=60.0)
    for number, words in enumerate(said, start=1):
        report, before = Report(at=0.5 * number, robot="mill", **words), Before.of(belief)
        belief.merge(report)
        found = judge(entry, before, belief, report)
        if found is not None and found.feed is not Feed.ACCEPTED:
            return found
    return None


def end(command: Command, level: Evidence, *said: dict[str, Any]) -> tuple[Feed, Reason | None] | None:
    found = verdict(command, level, *said)
    return found and (found.feed, found.failure and found.failure.reason)


OPENED = {"state": STOPPED, "facts": facts(door="open")}
MILLED = {"state": STOPPED, "facts": facts(program=7)}


@pytest.mark.parametrize("command", [OPENING, MILLING], ids=["motion", "process"])
def test_who_names_its_work_done_must_report_what_it_sets(command: Command) -> None:
    said = {**OPENED, "facts": facts(door="open", program=7)}
    assert end(command, Evidence.IDS, {**said, "done": ID}) == DONE
    assert end(command, Evidence.IDS, {**said, "done": "1-0"}) is None
    assert end(command, Evidence.IDS, {"state": STOPPED, "done": ID}) == (Feed.FAILED, Reason.NOT_REACHED)


@pytest.mark.parametrize("level", Evidence, ids=lambda level: level.value)
@pytest.mark.parametrize("command", [OPENING, MILLING, LOOKING], ids=["motion", "process", "query"])
def test_what_the_machine_gives_up_has_failed(command: Command, level: Evidence) -> None:
    gave_up = {"state": STOPPED, "failed": ID, "failure": "tool_broken"}
    assert end(command, level, gave_up) == (Feed.FAILED, Reason.DEVICE_FAULT)


def test_a_motion_is_done_once_its_facts_are_reported_and_it_moved() -> None:
    assert end(OPENING, Evidence.JOINTS, {"state": MOVING}, OPENED) == DONE
    assert end(OPENING, Evidence.JOINTS, {"state": STOPPED}, {"state": STOPPED}) is None


def test_a_motion_that_stops_elsewhere_has_stopped_short() -> None:
    said = [{"state": MOVING}, {"state": STOPPED}, {"state": STOPPED}]
    assert QUIET_S < 0.5
    assert end(OPENING, Evidence.JOINTS, *said) == (Feed.FAILED, Reason.STOPPED_SHORT)


def test_a_process_must_be_seen_at_work_since_its_facts_may_be_those_of_the_last_one() -> None:
    assert end(MILLING, Evidence.JOINTS, MILLED, MILLED, MILLED) is None
    assert end(MILLING, Evidence.JOINTS, MILLED, {**MILLED, "state": MOVING}, MILLED) == DONE


@pytest.mark.parametrize("level", [Evidence.IDS, Evidence.JOINTS], ids=lambda level: level.value)
def test_a_switch_is_done_once_its_fact_is_reported(level: Evidence) -> None:
    assert end(CLAMPING, level, {"facts": facts(clamped=False)}) is None
    assert end(CLAMPING, level, {"facts": facts(clamped=True)}) == DONE


@pytest.mark.parametrize("level", Evidence, ids=lambda level: level.value)
def test_a_query_takes_no_answer_but_its_own(level: Evidence) -> None:
    assert verdict(LOOKING, level, {"answered": "1-0", "answer": "good"}) is None
    assert verdict(LOOKING, level, {"answered": ID, "answer": "bad"}) == CommandVerdict(
        feed=Feed.DONE, answer="bad"
    )
