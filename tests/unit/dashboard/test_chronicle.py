from __future__ import annotations

from collections.abc import Callable
from typing import Any

from arboleda.core.messages import Verb
from arboleda.dashboard.chronicle import EVENTS, Chronicle


def told_of(rig: Any, kind: str) -> list[tuple[str, str, str]]:
    events = rig.story.chronicle.events
    return [(each["subject"], each["what"], each["sentence"]) for each in events if each["kind"] == kind]


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
    chronicle = Chronicle([{"at": 5.0, "scope": "", "sentence": "stop plant"}])
    assert [(event["at"], event["sentence"]) for event in chronicle.events] == [(5.0, "stop plant")]


def test_the_time_line_is_bounded() -> None:
    acts = [{"at": float(n), "scope": "", "sentence": "stop plant"} for n in range(EVENTS + 5)]
    events = Chronicle(acts).events
    assert len(events) == EVENTS and events[-1]["number"] == EVENTS + 5
