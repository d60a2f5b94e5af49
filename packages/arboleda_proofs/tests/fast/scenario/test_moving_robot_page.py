"""The page on robots that move: its kind, driver and recipe need nothing but what is public, and hold."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli

PAGE = (Path(__file__).parents[5] / "docs/how-to/add-a-moving-robot.md").read_text("utf-8")
PYTHON = PAGE.split("```python\n")[1].partition("```")[0]
PLANT = PAGE.split("```yaml\n")[1].partition("```")[0]
PUBLIC = {"arboleda.kinds", "arboleda.drivers", "arboleda.recipes"}


@pytest.fixture
def plant(tmp_path: Path) -> str:
    (tmp_path / "turntable.py").write_text(PYTHON, "utf-8")
    (tmp_path / "plant.yaml").write_text(PLANT, "utf-8")
    return str(tmp_path / "plant.yaml")


def assert_judged(plant: str) -> None:
    words = ["simulate", "--plant", plant, "--seeds", "1", "--cycles", "4", "--faults", "many"]
    outcome = CliRunner().invoke(cli, words)
    assert outcome.exit_code == 0, outcome.output


def test_it_imports_public_names_alone() -> None:
    imported = {node.module for node in ast.walk(ast.parse(PYTHON)) if isinstance(node, ast.ImportFrom)}
    assert {name for name in imported if name and name.startswith("arboleda")} == PUBLIC


def test_the_simulator_turns_it_with_faults_and_judges(plant: str) -> None:
    assert_judged(plant)


@pytest.mark.parametrize(
    ("robot", "home", "side"),
    [
        ("Axes(Axis('x', unit='mm', upper=900, speed=200))", "mm: 0", "mm: 600"),
        ("GridDrive(rows=3, columns=4, pitch_mm=150, mm_s=200)", "node: 0", "node: 11"),
    ],
)
def test_so_it_does_robots_that_move_in_another_way(plant: str, robot: str, home: str, side: str) -> None:
    python = PYTHON.replace("Axes(Axis(", robot + " or Axes(Axis(", 1).replace(
        "kinds import", "kinds import GridDrive,"
    )
    Path(plant).with_name("turntable.py").write_text(python, "utf-8")
    text = PLANT.replace("deg: [0]", home).replace("deg: [90]", side).replace("deg: [-90]", home)
    Path(plant).write_text(text.replace(", driver: table_bus", ""), "utf-8")
    assert_judged(plant)
