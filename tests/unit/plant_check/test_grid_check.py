"""`check` warns of a node in a zone by which another robot may drive without a target there."""

from __future__ import annotations

from pathlib import Path

import pytest

from ...plants import plant_text
from .test_meeting_points import warned

PLANT = plant_text(__file__, "grid_check")


def test_the_node_is_told_with_what_keeps_the_other_off(tmp_path: Path) -> None:
    (found,) = warned(tmp_path, PLANT)
    assert found == (
        "left is at gate in crossing, and nothing keeps two off its node 1 there;"
        " a target of two at it, in that zone, does"
    )


@pytest.mark.parametrize(
    "plant",
    [
        PLANT.replace("{left: {node: 5}}", "{left: {node: 5}, two: {node: 1}}"),
        PLANT.replace("[0.4, 0]", "[5, 0]"),
        PLANT.replace("zones:\n  crossing: {poses: [bay gate]}\n", ""),
    ],
    ids=["a target in the zone", "elsewhere", "no zone"],
)
def test_nothing_is_told_where_nobody_comes_by(tmp_path: Path, plant: str) -> None:
    assert warned(tmp_path, plant) == []
