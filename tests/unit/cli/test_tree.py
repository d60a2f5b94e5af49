from __future__ import annotations

import json
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.client import PlantClient
from arboleda.cli.main import cli
from arboleda.model.errors import ArboledaError
from arboleda.model.sentence import in_json
from arboleda.rig.rig import Rig
from arboleda.testing.plants import shipped
from arboleda.views import view

BEGINS = {"ascii": b"{o} storage", "svg": b"<svg", "png": b"\x89PNG", "dot": b"digraph"}


def tree(*words: str) -> Result:
    return CliRunner().invoke(cli, ["tree", *words])


@pytest.mark.parametrize(
    ("recipe", "steps"),
    [
        (
            "storage",
            ["main", "drive path 0A", "move to pick-up", "move to station 8", "recovery", "carry back"],
        ),
        ("palletizing", ["main", "move to home", "move to station 8", "recovery", "settle", "part back"]),
    ],
)
def test_a_recipe_is_drawn_with_its_recovery(recipe: str, steps: list[str]) -> None:
    drawn = tree(recipe)
    assert drawn.exit_code == 0
    places = [drawn.output.index(step) for step in steps]
    assert places == sorted(places)


@pytest.mark.sampled(7)
@pytest.mark.parametrize("recipe", ["storage", "palletizing"])
@pytest.mark.parametrize("format", BEGINS)
def test_every_recipe_has_every_format_without_graphviz(
    recipe: str, format: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    drawn = tree(recipe, "--format", format)
    assert drawn.exit_code == 0
    assert drawn.stdout_bytes.startswith(BEGINS[format].replace(b"storage", recipe.encode()))


def test_a_cell_that_is_not_there_is_refused_with_the_others() -> None:
    refused = tree("storage", "--cell", "sis_z")
    assert refused.exit_code == 2 and "sis_a, sis_b, sis_c" in refused.output


@pytest.fixture
def running() -> dict[str, Any]:
    """The status over HTTP of a plant in which sis_b palletizes and sis_a drives its mobile robot."""
    rig = Rig(shipped("sis_a", "sis_b"))
    rig.submit("sis_b palletizing")
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    return json.loads(json.dumps(view.snapshot(rig.plant), default=in_json))


def live(status: dict[str, Any], *words: str) -> Result:
    with mock.patch.object(PlantClient, "status", return_value=status):
        return tree(*words, "--live")


def test_a_running_tree_is_drawn_with_statuses(running: dict[str, Any]) -> None:
    lines = live(running, "storage").output.splitlines()
    assert lines[0] == "{o} storage [*]"
    assert "        --> drive path 0B [*] -- driving path 0B" in lines
    assert "        --> move to pick-up [-]" in lines


def test_the_cell_that_runs_the_recipe_is_found(running: dict[str, Any]) -> None:
    assert live(running, "palletizing").output.startswith("{o} palletizing [*]")


def test_a_recipe_that_does_not_run_is_told_with_what_does(running: dict[str, Any]) -> None:
    failed = live(running, "storage", "--cell", "sis_b")
    assert isinstance(failed.exception, ArboledaError)
    assert str(failed.exception) == "No storage runs in sis_b now; sis_b runs palletizing."


def test_a_running_cell_that_is_not_there_is_refused(running: dict[str, Any]) -> None:
    assert live(running, "storage", "--cell", "sis_z").exit_code == 2
