from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import pytest

from arboleda.dashboard.faces.moment import Moment, seconds
from arboleda.dashboard.faces.stop import face as stop_face
from arboleda.dashboard.faces.stop import stopped
from arboleda.dashboard.faces.tasks import sorted_tasks
from arboleda.dashboard.wording import words
from arboleda.model.messages import TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.views import view
from arboleda.views.changes import changed


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
    assert rig.face()["text/stop"] == ["All 6 robots latched and still", "stopped"]


def test_an_idle_cell_that_can_work_asks_for_a_task(told: Callable[..., Any]) -> None:
    rig = told()
    assert rig.face()["text/sis_a.offer"] == ["Send a task to sis_a", ""]
    rig.submit("sis_a 0B 7")
    rig.wait(0.2)
    assert rig.face()["text/sis_a.offer"] == ["", ""]
    rig.operate(Verb.STOP, "sis_b")
    rig.wait(3.0)
    assert rig.face()["text/sis_b.offer"] == ["", ""]


def test_a_held_cell_does_not_look_as_if_it_moved(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.operate(Verb.HOLD, "sis_a")
    assert rig.wait(10.0, until=lambda: rig.plant.cells["sis_a"].state.value == "held")
    face = rig.face()
    assert face["text/sis_a.feedback"][0] == "" and face["text/sis_a.step"] == ["drive path 0B", "held"]
    nodes = [node for key, node in face.items() if key.startswith("node/sis_a/")]
    assert {node["state"] for node in nodes} == {"success", "halted", "idle"}
    assert not [node for node in nodes if node["current"]]
    assert face["text/suggested.sis_a"][0] == "resume"


def test_a_stop_is_told_once_until_it_is_cleared(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.operate(Verb.STOP, "sis_a")
    assert rig.wait(10.0, until=lambda: rig.plant.cells["sis_a"].state.value == "aborted")
    face = rig.face()
    assert face["text/sis_a.cause"][0] == "" and "stopped" in face["text/sis_a.trouble"][0]
    rig.operate(Verb.CLEAR, "sis_a")
    assert rig.wait(10.0, until=lambda: rig.plant.cells["sis_a"].state.value == "stopped")
    assert rig.face()["text/sis_a.cause"][0] == "sis_a was stopped by the operator"


def test_a_task_shows_how_it_stands_and_how_it_ended(told: Callable[..., Any]) -> None:
    rig = told()
    first, second = (rig.submit(text).task for text in ("sis_a 0B 7", "sis_a 0B 3"))
    rig.wait_for("sis_a", "drive path 0B")
    assert "It waits for its cell" in rig.story.task_face(second, "en")["text/task.note"][0]
    running = rig.story.task_face(first, "en")
    assert "It runs now" in running["text/task.note"][0] and running["tree/#task"]["nodes"] == []
    rig.lost = lambda publication: publication.topic == "rm_sis_a/sensores"
    assert rig.wait(60.0, until=lambda: first in rig.story.ended)
    face = rig.story.task_face(first, "en")
    assert face["text/task.title"][0] == f"sis_a 0B 7 #{first}"
    assert face["text/task.state"] == ["failed", "failed"] and face["text/task.note"][0] == ""
    assert face["text/task.cause"][0].startswith('Failed in step "drive path 0B": rm_sis_a')
    leaf = next(node["path"] for node in face["tree/#task"]["nodes"] if node["name"] == "drive path 0B")
    assert face[f"node/#task/{leaf}"]["state"] == "failure"
    assert "Falló el paso" in rig.story.task_face(first, "es")["text/task.cause"][0]


def test_a_task_that_a_package_wrote_about_leads_to_its_report(told: Callable[..., Any]) -> None:
    rig = told()
    task = rig.submit("sis_a 0B 7").task
    assert rig.story.task_face(task, "en")["text/task.report"] == ["", ""]
    rig.story.see({**view.snapshot(rig.plant), "chapters": [task]}, 1000.0 + rig.plant.now)
    label = "What packages wrote about it (report)"
    assert rig.story.task_face(task, "en")["text/task.report"] == [label, task]


def test_a_task_that_never_ran_or_is_not_known_says_so(told: Callable[..., Any]) -> None:
    rig = told()
    _, second = (rig.submit(text).task for text in ("sis_a 0B 7", "sis_a 0B 3"))
    rig.operate(Verb.CANCEL, second)
    face = rig.story.task_face(second, "en")
    assert (
        face["text/task.state"][1] == "cancelled"
        and "before a tree of it was seen" in face["text/task.note"][0]
    )
    unknown = rig.story.task_face("nix", "en")
    assert unknown["text/task.title"][0] == "#nix" and "knows no such task" in unknown["text/task.note"][0]


@pytest.mark.parametrize(
    ("count", "said"),
    [
        (1, "1 message of an unknown robot was rejected: ra_9"),
        (2, "2 messages of unknown robots were rejected; the last one: ra_9"),
    ],
)
def test_strays_are_counted_in_words_for_one_and_for_many(
    told: Callable[..., Any], count: int, said: str
) -> None:
    face = told().face(refused={"": {"count": count, "last": "ra_9"}})
    assert face["text/strays"] == [said, "warning"]


def test_who_stands_by_is_named_and_the_way_to_each_is_kept_for_when_the_plant_falls_silent(
    told: Callable[..., Any],
) -> None:
    waiting = [{"host": "host-b", "url": "http://10.0.0.6:8080"}, {"host": "host-c", "url": ""}]
    face = told().face(standbys=waiting)
    assert face["text/standbys"] == ["Standing by: host-b, host-c", "online"]
    assert face["list/standbys"] == [["host-b", "http://10.0.0.6:8080"]]
    alone = told().face(standbys=[])
    assert (alone["text/standbys"], alone["list/standbys"]) == (["", ""], [])


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
    assert face["text/sis_a.left"][0] == "at most 9 s more"
    assert 0 < face["bar/sis_a.progress"] < 1


def test_the_steps_are_told_in_spanish(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    assert rig.face("es")["text/sis_a.step"][0] == "ir a la recogida"


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
    assert "Stop (software): sis_a was stopped by the operator" in row["texts"]
    assert [(act["act"], act["of"]) for act in row["acts"]] == [("submit", "sis_a 0B 7")]


def test_the_panel_suggests_what_comes_next_and_says_what_would_be_refused(told: Callable[..., Any]) -> None:
    rig = told()
    assert rig.face()["text/suggested.plant"][0] == ""
    refused = json.loads(rig.face("es")["text/refused.sis_a"][0])
    assert refused["reset"] == "sis_a está inactiva; una celda se rearma tras un paro, una vez desenclavada"
    assert "home" not in refused and "home_by_hand" in json.loads(rig.face()["text/refused.ra1"][0])
    for verb, following in ((Verb.STOP, "clear"), (Verb.CLEAR, "reset"), (Verb.RESET, "resume")):
        rig.operate(verb, "sis_a")
        rig.wait(1.0)
        face = rig.face()
        assert face["text/suggested.sis_a"][0] == face["text/suggested.plant"][0] == following
        assert following not in json.loads(face["text/refused.sis_a"][0])
        assert following not in json.loads(face["text/refused.plant"][0])
        if following == "clear":
            for scope, language in (("sis_a", "en"), ("plant", "en"), ("sis_a", "es")):
                refused = json.loads(rig.face(language)[f"text/refused.{scope}"][0])
                after = {"en": "After Clear", "es": "Después de: Desenclavar"}[language]
                assert (refused["reset"], refused.get("resume", after)) == (after, after)
    assert "clear" in json.loads(rig.face()["text/refused.plant"][0])


def ways(face: dict[str, Any]) -> list[dict[str, Any]]:
    return [face[f"row/ways.sis_a/{number}"] for number in face["rows/ways.sis_a"]]


def test_the_advice_stands_on_the_card_as_buttons_in_the_order_to_press(told: Callable[..., Any]) -> None:
    rig = told()
    assert ways(rig.face()) == []
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.crash("ra_1")
    rig.wait(10.0)
    home, retry, abandon = ways(rig.face())
    (button,) = home["acts"]
    assert (home["state"], button["act"], button["of"]) == ("next", "home", "ra1")
    assert button["label"] == "Home ra1"
    assert (button["does"], button["refused"]) == ("ra1 is not homed", False)
    assert button["asks"] == ["Home ra1: this sets ra1 in motion. Is everybody clear?"]
    assert home["texts"] == ["", "Moves ra1."]
    assert (retry["state"], retry["acts"][0]["label"]) == ("later", "Retry sis_a")
    assert abandon["texts"][1] == "Or: Moves nothing." and abandon["acts"][0]["asks"] == []
    assert rig.face("es")["row/ways.sis_a/0"]["acts"][0]["label"] == "Referenciar ra1"


def test_what_would_be_refused_is_disabled_with_the_reason(told: Callable[..., Any]) -> None:
    rig = told()
    rig.operate(Verb.STOP, "sis_a")
    rig.wait(1.0)
    clear, reset, resume = ways(rig.face())
    assert (clear["acts"][0]["refused"], reset["acts"][0]["refused"]) == (False, True)
    assert reset["texts"][1] == "After Clear sis_a"
    assert resume["texts"][1] == "After Reset sis_a"


@pytest.mark.long
def test_what_may_come_first_is_named_with_what_may_be_done_instead(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    truth, rig.carry = rig.carry, faults.says("ra_1", estado=2)
    rig.wait(20.0)
    rig.carry = truth
    rig.wait(2.0)
    assert ways(rig.face())[-1]["texts"][1] == "After Retry sis_a or Release ra1"
    assert ways(rig.face("es"))[-1]["texts"][1] == "Después de: Reintentar sis_a o Soltar la pieza de ra1"


def test_what_only_a_hand_can_do_has_no_button(told: Callable[..., Any]) -> None:
    rig = told()
    rig.power_off("ra_1")
    rig.wait(2.0)
    face = rig.face()
    (hand,) = ways(face)
    assert (hand["state"], hand["texts"], hand["acts"]) == ("hand", ["Bring ra1 back", "ra1 is offline"], [])
    assert face["text/sis_a.state"] == ["idle, blocked", "blocked", ""]
    assert face["text/sis_a.trouble"] == ["ra1 is offline; bring ra1 back", "blocked"]
    assert face["text/title"] == ["⚠ sis_a: idle, blocked - arboleda", "trouble"]
    assert face["text/needs"][0] == "sis_a"
    assert face["text/sum"][1] == "blocked"


def test_a_part_that_would_fall_is_asked_about(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    truth, rig.carry = rig.carry, faults.says("ra_1", estado=2)
    assert rig.wait(20.0, until=lambda: rig.plant.cells["sis_a"].task is None)
    rig.carry = truth
    rig.wait(2.0)
    release = next(way for way in ways(rig.face()) if way["acts"][0]["act"] == "release")
    assert release["acts"][0]["asks"] == ["Release ra1: the part that ra1 holds will fall. Do it?"]
    assert release["texts"][1] == "Or: The part that ra1 holds falls."


def test_a_release_that_failed_stays_on_the_card_with_the_way_by_hand(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    rig.boards["ra_1"].body.stuck = True
    rig.operate(Verb.STOP, "sis_a")
    rig.wait(5.0)
    for verb in (Verb.CLEAR, Verb.RESET):
        assert rig.operate(verb, "sis_a") is None
        rig.wait(2.0)
    assert rig.operate(Verb.RELEASE, "ra1") is None
    assert rig.face()["text/sis_a.act"] == ["Under way: release ra1", "under_way"]
    rig.wait(10.0)
    said, outcome = rig.face()["text/sis_a.act"]
    assert outcome == "failed" and said.startswith("release ra1: failed (ra1: did not finish")
    by_hand = next(way for way in ways(rig.face()) if way["acts"] and way["acts"][0]["by_hand"])
    assert by_hand["acts"][0]["label"] == "Say that the part of ra1 was taken out"
    assert by_hand["acts"][0]["asks"] == ["Have you taken the part out of {of}? The plant will believe it."]
    assert rig.operate(Verb.RELEASE, "ra1", by_hand=True) is None
    assert rig.face()["text/sis_a.act"] == ["", ""]


def test_what_of_a_done_task_nobody_confirmed_is_on_its_row_and_on_its_card(told: Callable[..., Any]) -> None:
    rig = told(evidence=Evidence.JOINTS)
    task = rig.submit("sis_a 0B 7").task
    assert rig.wait(120.0, until=lambda: rig.outcomes()[task].state is TaskState.DONE)
    rig.wait(1.0)
    said = "not checked: whether the part was gripped and let go of"
    face = rig.face()
    assert face["text/sis_a.cause"] == ["", ""]
    assert face["text/sis_a.task"] == [f"sis_a 0B 7  done, {said}", "warning"]
    assert face[f"row/tasks/{task}"]["state"] == "done" and said in face[f"row/tasks/{task}"]["texts"]
    assert rig.story.task_face(task, "en")["text/task.cause"] == [said, "warning"]
    unchecked = "sin comprobar: si la pieza quedó sujeta y si se soltó"
    assert rig.face("es")["text/sis_a.task"][0] == f"sis_a 0B 7  hecha, {unchecked}"
    rig.submit("sis_a 0B 1")
    rig.wait(1.0)
    assert rig.face()["text/sis_a.task"] == ["sis_a 0B 1", "running"]


def test_the_cause_and_the_failed_step_stay_until_the_cell_works_again(told: Callable[..., Any]) -> None:
    rig = told()
    assert rig.face()["text/sis_a.failure"] == ["", ""]  # none in the record yet
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.crash("rm_sis_a")
    rig.wait(10.0)
    assert rig.face()["text/sis_a.failure"] == ["Last failure in the record", ""]
    assert rig.face()["text/sis_b.failure"] == ["", ""]
    said = 'Failed in step "drive path 0B": rm_sis_a: the link was lost while driving path 0B'
    assert rig.face()["text/sis_a.cause"] == [said, "failed"]
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "sis_a")
        rig.wait(1.0)
        assert rig.face()["text/sis_a.cause"] == [said, "failed"]
    rig.operate(Verb.HOME, "rm_sis_a")
    rig.wait(10.0)
    rig.submit("sis_a 0B 1")
    rig.operate(Verb.RESUME, "sis_a")
    rig.wait(1.0)
    face = rig.face()
    assert (face["text/sis_a.cause"][0], face["text/title"]) == ("", ["arboleda", "well"])


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


def test_cells_in_trouble_come_first_and_the_counts_lead_to_them(told: Callable[..., Any]) -> None:
    rig = told()
    assert rig.face()["order/cells"] == ["sis_a", "sis_b", "sis_c"]
    rig.operate(Verb.STOP, "sis_c")
    rig.wait(1.0)
    face = rig.face()
    assert face["order/cells"] == ["sis_c", "sis_a", "sis_b"]
    assert face["rows/counts"] == ["aborted", "idle"]
    assert face["row/counts/aborted"]["link"]["to"] == {"tab": "cells", "cell": "sis_c", "task": None}
    assert face["row/counts/idle"]["texts"] == ["idle: 2"]


def ready(face: dict[str, Any], of: str = "") -> dict[str, Any]:
    (row,) = face[f"rows/ready.{of}" if of else "rows/for_all"]
    found: dict[str, Any] = face[f"row/ready.{of}/{row}" if of else f"row/for_all/{row}"]
    return found


def test_one_button_leads_out_of_a_stop_for_a_cell_and_for_the_whole_plant(told: Callable[..., Any]) -> None:
    rig = told()
    assert rig.face()["rows/for_all"] == rig.face()["rows/ready.sis_a"] == []
    rig.operate(Verb.STOP)
    rig.wait(1.0)
    face = rig.face()
    for of, row in (("", ready(face)), ("sis_a", ready(face, "sis_a"))):
        (button,) = row["acts"]
        assert (button["act"], button["of"], button["refused"]) == ("ready", of, False)
        assert (row["due"]["act"], row["due"]["of"], row["due"]["asks"]) == ("clear", "sis_a", [])
        assert row["texts"] == ["First: Clear sis_a. Moves nothing."]
    assert ready(rig.face("es"), "sis_a")["acts"][0]["label"] == "Dejar lista de nuevo"
    assert face["list/stops"] == [rig.plant.acts[-1].number]


def test_before_robots_go_on_it_asks_which_will_move(told: Callable[..., Any]) -> None:
    rig = told()
    rig.operate(Verb.STOP, "sis_a")
    rig.submit("sis_a 0B 7")
    for verb in (Verb.CLEAR, Verb.RESET):
        rig.wait(1.0)
        rig.operate(verb, "sis_a")
    rig.wait(1.0)
    due = ready(rig.face(), "sis_a")["due"]
    assert (due["act"], due["asks"]) == (
        "resume",
        ["Resume sis_a: this sets ra1, rm_sis_a in motion. Is everybody clear?"],
    )


def test_what_only_a_hand_can_do_disables_the_button_and_is_named(told: Callable[..., Any]) -> None:
    rig = told()
    rig.power_off("ra_1")
    rig.wait(2.0)
    row = ready(rig.face(), "sis_a")
    assert (row["texts"], row["acts"][0]["refused"]) == (["By hand first: Bring ra1 back."], True)


def test_the_whole_plant_says_of_the_cell_in_trouble_what_comes_first(told: Callable[..., Any]) -> None:
    rig = told()
    for cell in ("sis_a", "sis_b"):
        rig.submit(f"{cell} 0B 7")
        rig.wait_for(cell, "drive path 0B")
    rig.submit("sis_c 0B 7")
    rig.operate(Verb.HOLD, "sis_b")
    assert rig.wait(10.0, until=lambda: rig.plant.cells["sis_b"].state.value == "held")
    refused = json.loads(rig.face()["text/refused.plant"][0])
    assert refused["reset"].startswith("sis_b is held")


def test_whatever_may_start_robots_asks(told: Callable[..., Any]) -> None:
    for language in ("en", "es"):
        for verb in (each for each in Verb if each.row.moves and each is not Verb.DO):
            assert words(language).asks(verb.value), verb
    rig = told()
    task = rig.submit("sis_a 0B 7").task
    rig.wait_for("sis_a", "drive path 0B")
    waits = rig.submit("sis_a 0B 3").task
    cancel, drop = (rig.face()[f"row/tasks/{id}"]["acts"][0]["asks"] for id in (task, waits))
    assert (len(cancel), drop) == (1, [])


def stop_moment(robots: list[dict[str, Any]], no_stop: Sequence[str] = ()) -> Moment:
    return Moment(
        snapshot={"robots": robots},
        layout={"no_stop": [*no_stop]},
        links={},
        trees={},
        events=[],
        words=words("en"),
        unix_s=0.0,
    )


def test_below_the_stop_button_stands_no_list_of_a_hundred_robots() -> None:
    robots = [robot(f"a{number}", still=False) for number in range(100)]
    assert stop_face(stop_moment(robots))["text/stop"][0].endswith("a6, a7 and 92 more")


def test_what_no_stop_reaches_is_said_below_the_stop_button() -> None:
    said = stop_face(stop_moment([robot("a1", latched=False)], no_stop=["lamp"]))["text/stop"][0]
    assert said == "Stops every robot of the plant. Nothing is sent to lamp: no stop reaches it"


def test_a_slow_memory_is_said_in_the_header_and_among_the_links(told: Callable[..., Any]) -> None:
    rig = told()
    fast = rig.face(memory={"typical_s": 0.002, "worst_s": 0.3, "is_slow": False})
    assert fast["text/memory"] == ["", ""] and fast["text/sum"][0] == ""
    slow = {"typical_s": 0.351, "worst_s": 0.62, "is_slow": True}
    line = "Memory: slow; whatever needs a commit waits 0.35 s for it now as a rule, and up to 0.62 s"
    assert rig.face(memory=slow)["text/memory"] == [line, "warning"]
    assert rig.face("es", memory=slow)["text/sum"][0] == "la memoria de la planta es lenta"
