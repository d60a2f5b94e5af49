from __future__ import annotations

from collections.abc import Callable
from itertools import combinations

import pytest

from arboleda.drawing.layout import HEIGHT, Layout, NodePlace, columns, outline, wide

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
