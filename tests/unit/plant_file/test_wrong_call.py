"""A call in a recipe that does not fit is told in words, with what the step takes."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load

PLANT = """
name: shop
uses: [recipes.py]
kinds:
  press: {facts: {door: [open, shut]}, verbs: {open: {effect: motion, sets: {door: open}}}}
cells:
  a: {devices: {press: {kind: press}}}
"""
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("go")
def go(cell):
    press = cell.device("press")
    return BODY
"""
RETRY = "retry(step, times=..., pause_s=..., causes=...)"
CALLS = {
    "cell.retry(press.open(), time=3)": "retry takes no 'time'; there are step, times, pause_s, causes; "
    "did you mean times?",
    "cell.retry()": f"retry is not given step; it is {RETRY}",
    "cell.retry(press.open(), 3)": f"retry is given too many values; it is {RETRY}",
    "press.becomes(door='open')": "becomes is not given at_most_s; it is becomes(at_most_s=...)",
    "work(press.open(), name='x')": "work takes no 'name'; there are none",
    "cell.using(press, press.open())": "using is given 'press'; it takes roles, as using(\"lift\", ...)",
}


def refusal(folder: Path, body: str) -> str:
    (folder / "recipes.py").write_text(RECIPES.replace("BODY", body))
    (folder / "plant.yaml").write_text(PLANT)
    with pytest.raises(ConfigError) as refused:
        load(folder / "plant.yaml")
    (problem,) = refused.value.problems
    return problem.removeprefix(f"{folder}/recipes.py:7:1: go cannot be built: ")


@pytest.mark.parametrize(("body", "said"), CALLS.items(), ids=CALLS)
def test_a_call_that_does_not_fit_is_told_with_what_the_step_takes(
    tmp_path: Path, body: str, said: str
) -> None:
    assert refusal(tmp_path, body) == said


def test_a_call_of_other_code_is_told_as_python_says_it(tmp_path: Path) -> None:
    assert refusal(tmp_path, "len()") == "TypeError: len() takes exactly one argument (0 given)"
