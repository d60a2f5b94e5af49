from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from arboleda.core.messages import Verb
from arboleda.dashboard.faces import changed
from arboleda.dashboard.faces.moment import seconds
from arboleda.dashboard.faces.panel import suggested
from arboleda.dashboard.faces.stop import stopped
from arboleda.dashboard.faces.tasks import sorted_tasks


def robot(name: str, **said: Any) -> dict[str, Any]:
    return {"name": name, "latched": True, "online": True, "state": 4, "still": True} | said


@pytest.mark.parametrize(
    ("robots", "state"),
    [
        ([robot("a", latched=False), robot("b", latched=False)], "ready"),
        ([robot("a"), robot("b")], "stopped"),
        ([robot("a", still=False), robot("b")], "stopping"),
        ([robot("a", state=0), robot("b")], "stopping"),
        ([robot("a"), robot("b", latched=False)], "partly"),
        ([robot("a"), robot("b", online=False)], "unconfirmed"),
        ([robot("a", online=False), robot("b", still=False)], "stopping"),
    ],
    ids=["none", "all", "moving", "not latched yet", "one cell", "silent", "silent and moving"],
)
def test_a_stop_is_over_only_when_the_robots_say_so(robots: list[dict[str, Any]], state: str) -> None:
    assert stopped({"robots": robots}, frozenset()).state == state


def test_a_robot_without_a_latch_only_has_to_stand_still() -> None:
    robots = {"robots": [robot("a", state=0)]}
    assert stopped(robots, frozenset({"a"})).state == "stopped"


def test_a_stop_goes_from_stopping_to_stopped(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.3)
    rig.operate(Verb.STOP)
    sentence, state = rig.face()["text/stop"]
    assert state == "stopping" and "ra1" in sentence
    rig.wait(3.0)
    assert rig.face()["text/stop"] == ["Stopped: all 6 robots latched and still", "stopped"]


def test_only_what_changed_is_told() -> None:
    assert changed({"a": 1, "b": [1]}, {"a": 1, "b": [2], "c": None}) == {"b": [2], "c": None}


def test_a_face_is_plain_json_and_says_the_same_twice(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    face = rig.face()
    assert json.loads(json.dumps(face)).keys() == face.keys()
    assert changed(face, rig.face()) == {}


def test_the_current_leaf_is_marked_with_its_times(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.7)
    face = rig.face()
    current = [node for key, node in face.items() if key.startswith("node/sis_a/") and node["current"]]
    assert len(current) == 1 and current[0]["feedback"] == "moving to pick-up"
    assert (current[0]["since"], current[0]["left"]) == ("1 s", "9 s")
    assert face["text/sis_a.step"][0] == "move to pick-up"
    assert face["text/sis_a.left"][0] == "9 s until it is given up"
    assert 0 < face["bar/sis_a.progress"] < 1


def test_the_steps_are_told_in_spanish(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    assert rig.face("es")["text/sis_a.step"][0] == "mover a recogida"


def test_what_runs_stands_before_what_waits_before_what_ended() -> None:
    tasks = [
        {"id": "old", "state": "done", "ended_at": 1.0},
        {"id": "new", "state": "failed", "ended_at": 2.0},
        {"id": "next", "state": "queued", "ended_at": None},
        {"id": "now", "state": "running", "ended_at": None},
    ]
    assert [task["id"] for task in sorted_tasks(tasks)] == ["now", "next", "new", "old"]


def test_a_failed_task_says_why_and_offers_to_be_sent_again(told: Callable[..., Any]) -> None:
    rig = told()
    task = rig.submit("sis_a 0B 7 #lot42").task
    rig.wait_for("sis_a", "move to pick-up")
    rig.operate(Verb.STOP)
    rig.wait(1.0)
    row = rig.face()[f"row/tasks/{task}"]
    assert row["state"] == "failed"
    assert "Stopped: sis_a was stopped by the operator" in row["texts"]
    assert [(act["act"], act["of"]) for act in row["acts"]] == [("submit", "sis_a 0B 7")]


@pytest.mark.parametrize(
    ("cell", "verbs"),
    [
        ({"state": "aborted"}, ("clear",)),
        ({"state": "stopped"}, ("reset",)),
        ({"state": "execute"}, ()),
        ({"state": "idle", "paused": True}, ("resume",)),
        ({"state": "held", "held_by": "a is held (x); retry a or abandon a"}, ("retry", "abandon")),
    ],
)
def test_the_panel_suggests_what_comes_next(cell: dict[str, Any], verbs: tuple[str, ...]) -> None:
    assert suggested({"paused": False, **cell}) == verbs


def test_refused_messages_are_counted_with_the_last_reason(told: Callable[..., Any]) -> None:
    face = told().face(
        refused={"ra1": {"count": 3, "last": "ra_1/sensores: bad"}, "": {"count": 1, "last": "?"}}
    )
    assert face["row/links/ra1"]["texts"][-1] == "3: ra_1/sensores: bad"
    assert face["row/links/ra2"]["texts"][-1] == "0"
    assert face["text/strays"][1] == "warning"


@pytest.mark.parametrize(
    ("value", "text"), [(None, ""), (0.4, "0 s"), (59.4, "59 s"), (125, "2:05 min"), (11220, "3:07 h")]
)
def test_spans_are_short(value: float | None, text: str) -> None:
    assert seconds(value) == text
