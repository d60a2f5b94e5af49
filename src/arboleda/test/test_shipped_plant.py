"""The package as installed carries its plant."""

from __future__ import annotations

from arboleda.plant_file.loader import load


def test_the_shipped_plant_has_its_three_cells() -> None:
    assert [cell.name for cell in load(None).cells] == ["sis_a", "sis_b", "sis_c"]
