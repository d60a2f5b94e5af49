from __future__ import annotations

import pytest

from arboleda.dashboard.tree_drawing import drawing
from arboleda.dashboard.wording import LANGUAGES, words
from arboleda.model.sentence import Phrase

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
