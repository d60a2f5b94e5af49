from __future__ import annotations

from typing import Any

from arboleda.drawing.folding import folded, shown_at, small_steps
from arboleda.trees import steps


def row(path: str, name: Any, status: str = "INVALID", **more: Any) -> dict[str, Any]:
    plain = {"path": path, "name": name, "status": status, "kind": "sequence", "parameters": {}}
    return {**plain, "feedback": "", "failure": None, "since_s": None, "deadline_s": None, **more}


TREE = [
    row("root", steps.TITLES["main"](), "RUNNING"),
    row("0", steps.EFFECTOR_ON(), "RUNNING"),
    row("0.0", steps.SWITCH(), "SUCCESS", kind="command", parameters={"command": "7-1"}),
    row("0.1", steps.DWELL(), "RUNNING", kind="dwell", since_s=0.2, deadline_s=0.8, feedback="waits"),
    row("1", steps.SETTLE(), kind="await"),
    row("2", "switch", kind="step"),
]


def test_a_node_of_small_steps_alone_is_a_leaf_that_says_what_they_say() -> None:
    shown = folded(TREE)
    assert [each["path"] for each in shown] == ["root", "0", "2"], "a user's own step is no small one"
    leaf = shown[1]
    assert (leaf["kind"], leaf["parameters"]) == ("command", {"command": "7-1"})
    assert (leaf["since_s"], leaf["deadline_s"], leaf["feedback"]) == (0.2, 0.8, "waits")
    assert shown[0]["kind"] == "sequence"


def test_a_small_step_that_failed_is_told_by_its_parent() -> None:
    failed = [
        {**each, "status": "FAILURE", "failure": "no"} if each["path"] == "0.0" else each for each in TREE
    ]
    failed = [{**each, "status": "INVALID"} if each["status"] == "RUNNING" else each for each in failed]
    assert folded(failed)[1]["failure"] == "no"


def test_small_steps_are_found_by_the_node_that_shows_them() -> None:
    assert {path: len(inside) for path, inside in small_steps(TREE).items()} == {"0": 2, "root": 1}
    assert shown_at("0.1", TREE) == "0" and shown_at("1", TREE) == "root" and shown_at("2", TREE) == "2"


def test_a_tree_of_one_small_step_is_shown() -> None:
    assert folded([row("root", steps.SETTLE())]) == [row("root", steps.SETTLE())]
