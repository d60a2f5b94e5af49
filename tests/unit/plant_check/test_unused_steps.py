"""`check` warns of a step that a recipe makes with a name and never does."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_check import checks

from ...plants import plant_text, read

PLANT = plant_text(__file__, "unused_steps")
RECIPE = """
from arboleda.recipes import Choice, parallel, recipe, work

@recipe("x")
def x(cell, how: Choice["once", "twice"]):
    lamp = cell.device("lamp")
    off = lamp.light(on=False)
    """


def warned(folder: Path, body: str) -> list[str]:
    return [each.partition("recipes.py:")[2] for each in checks.warnings(read(folder, PLANT, RECIPE + body))]


def test_a_step_with_a_name_that_stands_nowhere_is_warned_of_once(tmp_path: Path) -> None:
    assert warned(tmp_path, "return lamp.blink()") == [
        "7:1: x makes the step lamp light false as off and does it nowhere; "
        "let it stand in what the recipe returns, or delete it"
    ]


@pytest.mark.parametrize(
    "body",
    [
        "return off",
        "return work(lamp.blink(), off)",
        "return cell.retry(off)",
        "return off if how == 'twice' else lamp.blink()",
        "inner = work(lamp.blink(), off)\n    return work(inner, lamp.blink())",
    ],
)
def test_a_step_that_some_task_does_is_not_told(tmp_path: Path, body: str) -> None:
    assert warned(tmp_path, body) == []
