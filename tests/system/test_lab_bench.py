"""Cells of devices as a person starts them: the example does its tasks, a bad recipe ends with a sentence."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.system

PLANT = Path(__file__).parents[2] / "examples/lab_bench/plant.yaml"


def test_the_bench_of_the_examples_does_its_tasks(arboleda: Callable[..., Any]) -> None:
    tasks = ("bench weigh 10", "bench incubate 5 60")
    run = arboleda("run", *tasks, "--plant", str(PLANT), "--rate", "20", "--no-ros")
    assert run.wait() == 0, run.output
    assert all(f"done      {task}" in run.output for task in tasks)
    assert "heater: still, clamped no" in run.output


def test_a_recipe_that_is_never_built_keeps_the_plant_from_starting(
    arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    (tmp_path / "plant.yaml").write_bytes(PLANT.read_bytes())
    recipes = (PLANT.parent / "recipes.py").read_text("utf-8")
    endless = recipes.replace("    code = reader.scan()\n", "    while True:\n        code = reader.scan()\n")
    (tmp_path / "recipes.py").write_text(endless, "utf-8")
    up = arboleda("up", "--plant", str(tmp_path / "plant.yaml"), "--no-ros")
    assert up.wait() == 2
    told = " ".join(up.output.split())
    assert re.search("building incubate for bench takes more than (10 s of processor time|40 s)", told)
    assert "Traceback" not in up.output and "broker:" not in up.output
