from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.dashboard.faces.moment import clock
from arboleda.model.messages import Journal, Verb
from arboleda.runtime.parts.plant_log import act_line
from arboleda.testing import Rig, shipped
from arboleda.views import view
from arboleda.views.chronicle import EVENTS, Chronicle


def act(**said: Any) -> dict[str, Any]:
    """An act of an operator, at unix s."""
    return said


def told_of(rig: Any, kind: str) -> list[tuple[str, str, str]]:
    events = rig.story.chronicle.events
    return [(each["subject"], each["what"], str(each["sentence"])) for each in events if each["kind"] == kind]


def test_a_task_is_told_from_its_queue_to_its_end(told: Callable[..., Any]) -> None:
    rig = told()
    task = rig.submit("sis_a 0B 7").task
    rig.wait_for("sis_a", "move to pick-up")
    rig.operate(Verb.STOP, "sis_a")
    rig.wait(1.0)
    assert told_of(rig, "task") == [
        (task, "running", f"sis_a 0B 7 #{task}"),
        (task, "failed", f"sis_a 0B 7 #{task}: sis_a was stopped by the operator"),
    ]


def test_why_a_task_is_done_in_its_cell_is_told_once(told: Callable[..., Any]) -> None:
    rig = told()
    task = rig.submit("sis_a,sis_b palletizing").task
    rig.wait(30.0)
    first, last = told_of(rig, "task")
    assert first[0] == task and "sis_a is expected to have done it first, in 60 s; sis_b in 60 s" in first[2]
    assert last == (task, "done", f"sis_a palletizing #{task}")


def test_an_operators_act_is_told_once_with_its_cell(told: Callable[..., Any]) -> None:
    rig = told()
    rig.operate(Verb.STOP, "ra1")
    rig.wait(2.0)
    assert told_of(rig, "operator") == [("ra1", "did", "stop ra1")]
    assert [each["cell"] for each in rig.story.chronicle.events if each["kind"] == "operator"] == ["sis_a"]


def test_a_robot_that_falls_silent_and_comes_back_is_told(told: Callable[..., Any]) -> None:
    rig = told()
    rig.lost = lambda publication: publication.topic == "ra_1/sensores"
    rig.wait(3.0)
    rig.lost = lambda publication: False
    rig.wait(1.0)
    states = [what for subject, what, _ in told_of(rig, "robot") if subject == "ra1"]
    assert states[-2:] == ["offline", "online"]


def test_a_plant_that_does_nothing_has_nothing_to_tell_of_its_cells(told: Callable[..., Any]) -> None:
    rig = told()
    rig.wait(5.0)
    assert told_of(rig, "cell") == [] and told_of(rig, "zone") == []


def test_what_operators_did_before_this_start_comes_first() -> None:
    chronicle = Chronicle([act(at=5.0, scope="lot42", cell="sis_b", sentence="cancel lot42")])
    (event,) = chronicle.events
    assert (event["at"], event["cell"], str(event["sentence"])) == (5.0, "sis_b", "cancel lot42")


def test_an_act_keeps_its_cell_and_its_date_on_every_later_start(told: Callable[..., Any]) -> None:
    at = 86_400.0 * 365
    rig = told(past_acts=[act(at=at, scope="ra1", cell="sis_a", sentence="home ra1")])
    row = rig.face()["row/events/1"]
    assert row["cell"] == "sis_a" and row["texts"][1] == "sis_a"
    assert row["texts"][0] == time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(at))


def test_an_act_of_today_is_told_with_its_own_time_and_the_cell_of_its_task(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_b 0B 7 #lot42")
    rig.wait_for("sis_b", "move to pick-up")
    rig.operate(Verb.CANCEL, "lot42")
    at = 1000.0 + rig.now
    rig.wait(2.0)
    rig.operate(Verb.STOP)
    whole, one = [event for event in reversed(rig.story.chronicle.events) if event["kind"] == "operator"]
    assert (one["cell"], one["at"], whole["cell"]) == ("sis_b", pytest.approx(at), None)
    assert rig.face()[f"row/events/{one['number']}"]["texts"][0] == clock(at)


def test_an_act_that_is_seen_late_is_told_with_the_time_of_when_it_was_done() -> None:
    rig = Rig(shipped())
    rig.operate(Verb.STOP)
    rig.wait(3.0)
    chronicle = Chronicle()
    chronicle.see(view.snapshot(rig.plant), 1000.0)
    (act,) = [event for event in chronicle.events if event["kind"] == "operator"]
    assert act["at"] == pytest.approx(997.0, abs=0.2)


def test_the_log_line_of_an_act_names_its_cell_once() -> None:
    home = Journal(verb=Verb.HOME, scope="ra1", cell="sis_a", sentence="home ra1")
    assert str(act_line(home)) == "home ra1 (sis_a)"
    assert str(act_line(replace(home, scope="sis_a", sentence="home sis_a"))) == "home sis_a"
    assert str(act_line(replace(home, scope="", cell=None, sentence="stop plant"))) == "stop plant"


def test_the_time_line_is_bounded() -> None:
    acts = [act(at=float(n), scope="", cell=None, sentence="stop plant") for n in range(EVENTS + 5)]
    events = Chronicle(acts).events
    assert len(events) == EVENTS and events[-1]["number"] == EVENTS + 5
