"""The part that shows trees to Groot2 starts after the page."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from tests.unit.runtime.test_order_of_parts import SHIPPED, names


def test_what_shows_trees_to_groot2_comes_after_the_page(tmp_path: Path) -> None:
    found = names(tmp_path, model=replace(SHIPPED, groot2_port=0))
    assert found.index("Groot2Part") > found.index("WebPart")


def test_nobody_is_shown_trees_who_has_not_asked_for_them(tmp_path: Path) -> None:
    assert "Groot2Part" not in names(tmp_path)
