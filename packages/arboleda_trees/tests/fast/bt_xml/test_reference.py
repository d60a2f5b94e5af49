"""The page of what is known names every kind of node."""

from __future__ import annotations

import re
from pathlib import Path

from arboleda_trees.bt_xml.nodes import BUILT_IN, OTHER_SPELLINGS

PAGE = Path(__file__).parents[5] / "docs/reference/bt-xml.md"
IN_OTHER_WORDS = {
    "Switch3",
    "Switch4",
    "Switch5",
    "BlackboardCheckDouble",
    "BlackboardCheckString",
    "BlackboardCheckBool",
}


def test_every_kind_is_on_the_page() -> None:
    named = set(re.findall(r"`(\w+)`", PAGE.read_text("utf-8")))
    assert {*BUILT_IN, *OTHER_SPELLINGS} - named - IN_OTHER_WORDS - {"Subtree"} == set()
