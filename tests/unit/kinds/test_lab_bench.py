"""examples/lab_bench: a plant of declared devices and two recipes, and nothing else."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from arboleda.model.messages import TaskState
from arboleda.plant_file import loader

from .lab import Bench

FOLDER = Path(__file__).parents[3] / "examples/lab_bench"


@pytest.fixture(scope="module")
def here() -> Bench:
    return Bench(loader.load(FOLDER / "plant.yaml"))


@pytest.mark.parametrize(
    ("task", "told"),
    [
        ("bench weigh 10", ["scale tare", "pump dispense", "scale weigh"]),
        (
            "bench incubate 5 60",
            [
                "reader scan",
                "pump dispense",
                "heater clamp",
                "heater close",
                "heater heat",
                "heater heat",
                "heater open",
                "heater clamp",
                "pump rinse",
            ],
        ),
    ],
)
def test_its_recipes_are_done(here: Bench, task: str, told: list[str]) -> None:
    before = len(here.told)
    here.submit(task)
    assert here.outcome(200.0).state is TaskState.DONE
    assert here.told[before:] == told


def test_a_wrong_dose_is_refused_with_what_there_is(here: Bench) -> None:
    here.submit("bench weigh 7")
    refused = here.outcome()
    assert refused.state is TaskState.REFUSED
    assert "ml of bench cannot be '7'; there are 5, 10, 20" in str(refused.sentence)


def test_it_is_short_and_imports_only_what_is_public() -> None:
    plant, recipes = (FOLDER / name for name in ("plant.yaml", "recipes.py"))
    assert len(plant.read_text("utf-8").splitlines()) < 80
    source = recipes.read_text("utf-8")
    assert len(source.splitlines()) < 30
    imports = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Import | ast.ImportFrom)]
    assert [getattr(node, "module", None) for node in imports] == ["arboleda.recipes"]
