"""How a tree is laid out and folded."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import Any

import pytest

from arboleda.drawing.folding import folded, shown_at, small_steps
from arboleda.drawing.layout import HEIGHT, Layout, NodePlace, columns, outline, wide
from arboleda.trees import steps

TREE = (
    ("root", "? storage"),
    ("0", "? main"),
    ("0.0", "system start"),
    ("0.1", "drive path 0B"),
    ("1", "? recovery"),
    ("1.0", "settle"),
)
ways = pytest.mark.parametrize("way", [wide, columns, outline])
Way = Callable[..., Layout]


@ways
def test_no_two_nodes_overlap_and_all_are_inside(way: Way) -> None:
    plan = way(TREE)
    assert all(x + w <= plan.width and y + HEIGHT <= plan.height for x, y, w in plan.places.values())
    assert not [pair for pair in combinations(plan.places.values(), 2) if overlap(*pair)]


def overlap(one: NodePlace, other: NodePlace) -> bool:
    apart = one[0] + one[2] <= other[0] or other[0] + other[2] <= one[0]
    return not apart and abs(one[1] - other[1]) < HEIGHT


@ways
def test_every_node_but_the_root_hangs_on_its_parent(way: Way) -> None:
    assert way(TREE).lines.keys() == {path for path, _ in TREE} - {"root"}


@ways
def test_nothing_is_drawn_of_no_tree(way: Way) -> None:
    assert way(()).places == {}


def test_from_left_to_right_a_line_leaves_its_parent_at_the_right() -> None:
    plan = wide(TREE)
    x, y, width = plan.places["0"]
    assert plan.lines["0.1"][0] == (x + width, y + HEIGHT / 2)


def test_from_left_to_right_a_node_stands_in_the_line_of_its_first_child() -> None:
    at = wide(TREE).places
    assert at["root"][1] == at["0"][1] == at["0.0"][1] < at["0.1"][1] < at["1"][1] == at["1.0"][1]
    assert at["root"][0] < at["0"][0] == at["1"][0] < at["0.0"][0]


def test_columns_stand_side_by_side_below_the_root() -> None:
    at = columns(TREE).places
    assert at["root"][1] < at["0"][1] == at["1"][1]
    assert max(at[path][0] + at[path][2] for path in ("0", "0.0", "0.1")) < at["1"][0]


def test_an_outline_has_a_line_per_node() -> None:
    assert len({y for _, y, _ in outline(TREE).places.values()}) == len(TREE)


def row(path: str, name: Any, status: str = "INVALID", **more: Any) -> dict[str, Any]:
    plain = {"path": path, "name": name, "status": status, "kind": "sequence", "parameters": {}}
    return {**plain, "feedback": "", "failure": None, "since_s": None, "deadline_s": None, **more}


FOLDED = [
    row("root", steps.TITLES["main"](), "RUNNING"),
    row("0", steps.EFFECTOR_ON(), "RUNNING"),
    row("0.0", steps.SWITCH(), "SUCCESS", kind="command", parameters={"command": "7-1"}),
    row("0.1", steps.DWELL(), "RUNNING", kind="dwell", since_s=0.2, deadline_s=0.8, feedback="waits"),
    row("1", steps.SETTLE(), kind="await"),
    row("2", "switch", kind="step"),
]


def test_a_node_of_small_steps_alone_is_a_leaf_that_says_what_they_say() -> None:
    shown = folded(FOLDED)
    assert [each["path"] for each in shown] == ["root", "0", "2"], "a user's own step is no small one"
    leaf = shown[1]
    assert (leaf["kind"], leaf["parameters"]) == ("command", {"command": "7-1"})
    assert (leaf["since_s"], leaf["deadline_s"], leaf["feedback"]) == (0.2, 0.8, "waits")
    assert shown[0]["kind"] == "sequence"


def test_a_small_step_that_failed_is_told_by_its_parent() -> None:
    failed = [
        {**each, "status": "FAILURE", "failure": "no"} if each["path"] == "0.0" else each for each in FOLDED
    ]
    failed = [{**each, "status": "INVALID"} if each["status"] == "RUNNING" else each for each in failed]
    assert folded(failed)[1]["failure"] == "no"


def test_small_steps_are_found_by_the_node_that_shows_them() -> None:
    assert {path: len(inside) for path, inside in small_steps(FOLDED).items()} == {"0": 2, "root": 1}
    assert shown_at("0.1", FOLDED) == "0" and shown_at("1", FOLDED) == "root" and shown_at("2", FOLDED) == "2"


def test_a_tree_of_one_small_step_is_shown() -> None:
    assert folded([row("root", steps.SETTLE())]) == [row("root", steps.SETTLE())]
