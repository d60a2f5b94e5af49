from __future__ import annotations

import pytest
from typer.testing import CliRunner

from arboleda.app.cli import cli


@pytest.mark.parametrize(
    ("recipe", "steps"),
    [
        (
            "storage",
            ["main", "drive path 0A", "move to pick-up", "move to station 8", "recovery", "carry back"],
        ),
        (
            "palletizing",
            ["main", "move to home", "move to station 8", "recovery", "settle", "part back"],
        ),
    ],
)
def test_a_recipe_is_drawn_with_its_recovery(recipe: str, steps: list[str]) -> None:
    drawn = CliRunner().invoke(cli, ["tree", recipe])
    assert drawn.exit_code == 0
    places = [drawn.output.index(step) for step in steps]
    assert places == sorted(places)


def test_a_cell_that_is_not_there_is_refused_with_the_others() -> None:
    refused = CliRunner().invoke(cli, ["tree", "storage", "--cell", "sis_z"])
    assert refused.exit_code == 2 and "sis_a, sis_b, sis_c" in refused.output
