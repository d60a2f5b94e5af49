from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.dashboard.tree_drawing import drawing
from arboleda.dashboard.tree_memory import EndedTree, TreeMemory, ancestors, judged, parent
from arboleda.dashboard.wording import LANGUAGES, words
from arboleda.model.messages import Verb
from arboleda.model.sentence import Phrase
from arboleda.testing import Rig, shipped


def row(path: str, status: str, *, kind: str = "command", failure: str | None = None) -> dict[str, Any]:
    plain = {"path": path, "name": path, "phase": None, "frame": False}
    return {**plain, "status": status, "kind": kind, "failure": failure}


def test_a_done_task_leaves_a_tree_that_succeeded(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    assert rig.wait(60.0, until=lambda: rig.plant.cells["sis_a"].tree is None)
    statuses = rig.statuses()
    assert statuses["storage"] == statuses["main"] == statuses["move to station 7"] == "success"
    assert statuses["recovery"] == "idle"


def test_a_failed_step_stays_failed_while_the_recovery_runs(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.lost = lambda publication: publication.topic == "rm_sis_a/sensores"
    assert rig.wait(9.0, until=lambda: str(rig.snapshot()["cells"][0]["step"]).startswith("recovery"))
    statuses = rig.statuses()
    assert statuses["drive path 0B"] == statuses["main"] == "failure"
    assert statuses["system start"] == "success"
    assert statuses["storage"] == statuses["recovery"] == "running"


def test_after_a_recovery_the_recovery_succeeded_and_the_task_failed(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.lost = lambda publication: publication.topic == "rm_sis_a/sensores"
    assert rig.wait(60.0, until=lambda: rig.plant.cells["sis_a"].tree is None)
    statuses = rig.statuses()
    assert statuses["recovery"] == "success" and statuses["storage"] == statuses["main"] == "failure"


def test_a_step_that_failed_between_two_snapshots_shows_it() -> None:
    cell = replace(shipped().cells[0], drive_to_start=False)
    rig, memory = Rig(replace(shipped(), cells=(cell,))), TreeMemory()
    rig.wait(0.5)
    task = rig.submit("sis_a 2A 5").task
    rig.wait_for("sis_a", "system start/dwell")
    for seconds in (0.0, 5.0):
        rig.wait(seconds)
        see(memory, rig)
    statuses = {str(row["name"]): memory.statuses[row["path"]] for row in memory.rows}
    assert statuses["storage"] == statuses["main"] == statuses["at start"] == "failure"
    assert statuses["system start"] == "success" and statuses["drive path 2A"] == "idle"
    failures = {str(row["name"]): row["failure"] for row in memory.rows if row["failure"]}
    assert failures == {"at start": rig.outcomes()[task].sentence}


def test_what_a_stop_interrupts_is_called_interrupted(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.operate(Verb.STOP)
    rig.wait(1.0)
    assert rig.statuses()["storage"] == "failure"
    pickup = rig.face()["rows/changes.sis_a"]
    assert pickup  # the changes tell of it
    names = {(str(change.name), change.status) for change in rig.story.trees["sis_a"].changes}
    assert ("move to pick-up", "halted") in names and ("drive path 0B", "success") in names


def test_the_changes_tell_of_steps_each_once(told: Callable[..., Any]) -> None:
    rig = told()
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "effector on/dwell")
    told_of = [(str(change.name), change.status) for change in rig.story.trees["sis_a"].changes]
    done = ("system start", "be at node 0", "drive path 0B", "move to pick-up", "piece there")
    assert told_of == [*((name, "success") for name in done), ("grip", "running")]


def test_the_changes_name_the_leaf_that_failed_within_a_step() -> None:
    memory = TreeMemory()
    rows = [
        row("root", "RUNNING", kind="selector") | {"name": "storage"},
        row("0", "RUNNING", kind="sequence") | {"name": "main", "phase": "main"},
        row("0.0", "RUNNING", kind="sequence") | {"name": "grip"},
        row("0.0.0", "RUNNING") | {"name": "switch"},
    ]
    failed = [each | {"status": "FAILURE"} if each["path"] != "root" else each for each in rows]
    for number, tree in enumerate((rows, failed)):
        memory.see({"tree": tree, "task": {"id": "t"}, "state": "execute"}, [], float(number))
    assert [(change.name, change.status) for change in memory.changes] == [
        ("grip", "failure"),
        ("switch", "failure"),
    ]


def test_the_tree_of_an_ended_task_stays_while_the_task_is_shown(told: Callable[..., Any]) -> None:
    rig = told()
    first = rig.submit("sis_a 0B 7").task
    assert rig.wait(60.0, until=lambda: first in rig.story.ended)
    kept = rig.story.ended[first]
    assert set(kept.statuses.values()) == {"success", "idle"}
    rig.submit("sis_a 0B 3")
    rig.wait_for("sis_a", "move to station 3")
    assert rig.story.ended[first] == kept
    snapshot = rig.snapshot()
    rig.story.see(snapshot | {"tasks": [row for row in snapshot["tasks"] if row["id"] != first]}, 0.0)
    assert rig.story.ended == {}


def test_a_tree_that_ended_between_two_snapshots_is_kept_though_the_next_one_runs() -> None:
    rig, memory = Rig(shipped()), TreeMemory()
    rig.wait(0.5)
    first = rig.submit("sis_a 0B 7").task
    rig.submit("sis_a 0B 3")
    rig.wait_for("sis_a", "move to home")
    assert see(memory, rig) is None
    rig.wait_for("sis_a", "be at node 0")
    ended = see(memory, rig)
    assert ended is not None and ended.task == first
    assert set(ended.statuses.values()) == {"success", "idle"}
    assert memory.task != first and "be at node 0" in {str(row["name"]) for row in memory.rows}


@pytest.mark.parametrize(("verb", "came_to"), [(Verb.ABANDON, "failure"), (Verb.CANCEL, "halted")])
def test_a_recovery_of_its_own_ends_as_a_part_of_the_work_that_it_ended(
    verb: Verb, came_to: str, told: Callable[..., Any]
) -> None:
    rig = told()
    task = rig.submit("sis_a 0B 7").task
    rig.wait_for("sis_a", "move to station 7")
    if verb is Verb.ABANDON:
        rig.operate(Verb.HOLD, "sis_a")
        assert rig.wait(10.0, until=lambda: rig.plant.cells["sis_a"].state.value == "held")
    assert rig.operate(verb, "sis_a") is None
    assert rig.story.trees["sis_a"].rows[0]["phase"] == "recovery"
    assert rig.wait(60.0, until=lambda: task in rig.story.ended)
    statuses = rig.statuses()
    assert statuses["drive path 0B"] == statuses["recovery"] == statuses["carry back"] == "success"
    assert (statuses["storage"], statuses["main"]) == (came_to, "halted")
    assert statuses["move to station 7"] == "halted"
    assert rig.story.ended[task].statuses == rig.story.trees["sis_a"].statuses


def see(memory: TreeMemory, rig: Rig) -> EndedTree | None:
    snapshot = rig.snapshot()
    return memory.see(snapshot["cells"][0], snapshot["tasks"], 1000.0 + rig.now)


def test_a_new_task_begins_with_a_fresh_tree(told: Callable[..., Any]) -> None:
    rig = told()
    for text in ("sis_a 0B 7", "sis_a 0B 3"):
        rig.submit(text)
    assert rig.wait(60.0, until=lambda: not rig.plant.cells["sis_a"].queue)
    assert set(rig.statuses().values()) <= {"running", "idle", "success"}
    assert rig.statuses()["main"] == "running" and rig.statuses()["move to station 3"] == "idle"


@pytest.mark.parametrize(
    ("rows", "before", "after"),
    [
        ([row("root", "RUNNING")], {}, {"root": "running"}),
        ([row("root", "INVALID")], {"root": "running"}, {"root": "halted"}),
        ([row("root", "INVALID", failure="why")], {"root": "running"}, {"root": "failure"}),
        ([row("root", "INVALID")], {"root": "success"}, {"root": "success"}),
        ([row("root", "INVALID")], {}, {"root": "idle"}),
        (
            [
                row("root", "INVALID", kind="sequence"),
                row("0", "INVALID"),
                row("1", "INVALID", failure="why"),
            ],
            {"root": "running", "0": "running", "1": "idle"},
            {"root": "failure", "0": "success", "1": "failure"},
        ),
        (
            [
                row("root", "RUNNING", kind="selector"),
                row("0", "INVALID", failure="why"),
                row("1", "RUNNING"),
            ],
            {"root": "running", "0": "running"},
            {"root": "running", "0": "failure", "1": "running"},
        ),
    ],
    ids=["runs", "halted", "failed", "was done", "never ran", "in one step", "next branch"],
)
def test_a_node_that_was_reset_keeps_what_it_came_to(
    rows: list[dict[str, Any]], before: dict[str, str], after: dict[str, str]
) -> None:
    assert judged(rows, before) == after


def test_paths_lead_to_the_root() -> None:
    assert parent("root") is None and parent("0") == "root" and parent("0.2.1") == "0.2"
    assert ancestors("0.2.1") == ["0.2", "0", "root"]


TREE = tuple(
    (path, Phrase(f"step.{name}", name)(), kind)
    for path, name, kind in (
        ("root", "storage", "selector"),
        ("0", "main", "sequence"),
        ("1", "recovery", "sequence"),
    )
)


def test_a_tree_is_drawn_in_three_ways_the_widest_first() -> None:
    ways = drawing((("root", "storage", "command"), ("0", "main", "command")), words("en"))
    assert list(ways) == ["wide", "columns", "narrow", "need"]
    assert ways["narrow"]["at"] == {"root": [4, 4, 92], "0": [24, 34, 70]}
    assert ways["narrow"]["lines"] == {"0": "M14 30L14 47L24 47"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_how_much_room_a_way_needs_is_the_same_in_every_language(language: str) -> None:
    drawn = [drawing(TREE, words(each)) for each in LANGUAGES]
    widest = {way: max(each[way]["w"] for each in drawn) for way in ("wide", "columns", "narrow")}
    assert drawing(TREE, words(language))["need"] == widest
    assert drawn[0]["wide"]["w"] != drawn[1]["wide"]["w"]
