"""docs/reference/proof.md is what `tools/proof-table` finds: it has all plants, and one is run again."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_file import loader

from ..scripts import printed

ROOT = Path(__file__).parents[2]
ROWS = [
    [cell.strip() for cell in line.strip("|").split("|")]
    for line in (ROOT / "docs/reference/proof.md").read_text(encoding="utf-8").splitlines()
    if line.startswith("| ") and not line.startswith("| plant")
]
AGAIN = "press_board"


@pytest.mark.sampled(3)
@pytest.mark.parametrize("plant", sorted({row[0] for row in ROWS}))
def test_the_page_has_each_recipe_of_each_cell(plant: str) -> None:
    model = loader.load(None if plant == "shipped" else ROOT / "examples" / plant / "plant.yaml")
    recipes = [f"{cell.name}: {recipe.name}" for cell in model.cells for recipe in cell.recipes]
    assert [row[1] for row in ROWS if row[0] == plant] == recipes


def test_the_shipped_plant_is_there_and_nothing_breaks() -> None:
    assert "shipped" in {row[0] for row in ROWS} and len(ROWS) > 10
    assert {row[9] for row in ROWS if len(row) > 9} <= {"0", ""}


@pytest.mark.long
def test_the_rows_of_a_plant_are_what_its_runs_say(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda_proofs.campaigns.proof.forks.CAN_FORK", False)  # no process beside a test
    found = [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in printed("proof-table", AGAIN).splitlines()
    ]
    assert found == [row for row in ROWS if row[0] == AGAIN]
