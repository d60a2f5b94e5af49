"""A simulation says of what nothing is known."""

from __future__ import annotations

import json
from pathlib import Path

from tests.unit.plant_check.test_unstated import GUARD, NEEDS, PLACES, PLANT, RECIPE, written
from typer.testing import CliRunner

from arboleda.cli.main import cli


def test_a_simulation_says_of_what_nothing_is_known(tmp_path: Path) -> None:
    words = [
        "--seeds",
        "1",
        "--cycles",
        "1",
        "--faults",
        "none",
        "--jobs",
        "1",
        "--json",
        str(tmp_path / "out.json"),
    ]
    said = CliRunner().invoke(cli, ["simulate", "--plant", str(written(tmp_path, PLANT, RECIPE)), *words])
    assert PLACES in said.output
    assert json.loads((tmp_path / "out.json").read_text())["unknown"] == [PLACES, GUARD, NEEDS]
