from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest

from arboleda.dashboard.tree_drawing import HEIGHT, drawing

TREE = (
    ("root", "? storage"),
    ("0", "→ main"),
    ("0.0", "system start"),
    ("0.1", "drive path 0B"),
    ("1", "→ recovery"),
    ("1.0", "settle"),
)


@pytest.mark.parametrize("how", ["wide", "columns", "narrow"])
def test_no_two_nodes_overlap_and_all_are_inside(how: str) -> None:
    plan = drawing(TREE)[how]
    boxes = list(plan["at"].values())
    assert all(x + w <= plan["w"] and y + HEIGHT <= plan["h"] for x, y, w in boxes)
    assert not [pair for pair in combinations(boxes, 2) if overlap(*pair)]


def overlap(one: list[Any], other: list[Any]) -> bool:
    apart = one[0] + one[2] <= other[0] or other[0] + other[2] <= one[0]
    return not apart and abs(one[1] - other[1]) < HEIGHT


@pytest.mark.parametrize("how", ["wide", "columns", "narrow"])
def test_every_node_but_the_root_hangs_on_its_parent(how: str) -> None:
    assert drawing(TREE)[how]["lines"].keys() == {path for path, _ in TREE} - {"root"}


def test_from_left_to_right_a_node_stands_in_the_line_of_its_first_child() -> None:
    at = drawing(TREE)["wide"]["at"]
    assert at["root"][1] == at["0"][1] == at["0.0"][1] < at["0.1"][1] < at["1"][1] == at["1.0"][1]
    assert at["root"][0] < at["0"][0] == at["1"][0] < at["0.0"][0]


def test_columns_stand_side_by_side_below_the_root() -> None:
    at = drawing(TREE)["columns"]["at"]
    assert at["root"][1] < at["0"][1] == at["1"][1]
    assert max(at[path][0] + at[path][2] for path in ("0", "0.0", "0.1")) < at["1"][0]


def test_an_outline_has_a_line_per_node() -> None:
    at = drawing(TREE)["narrow"]["at"]
    assert len({y for _, y, _ in at.values()}) == len(TREE)


def test_nothing_is_drawn_of_no_tree() -> None:
    assert drawing(())["wide"]["at"] == {}
