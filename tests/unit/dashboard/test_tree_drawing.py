from __future__ import annotations

from arboleda.dashboard.tree_drawing import drawing


def test_a_tree_is_drawn_in_three_ways_the_widest_first() -> None:
    ways = drawing((("root", "storage"), ("0", "main")))
    assert list(ways) == ["wide", "columns", "narrow"]
    assert ways["narrow"]["at"] == {"root": [4, 4, 92], "0": [24, 34, 70]}
    assert ways["narrow"]["lines"] == {"0": "M14 30L14 47L24 47"}
