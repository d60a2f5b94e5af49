"""A call in a recipe that does not fit, or that is misspelled, is told in words, with what the step takes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda.model.errors import ConfigError
from arboleda.recipes.errors import Offers, misspelled

from ...plants import plant_text, read

PLANT = plant_text(__file__, "wrong_call")
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
    with pytest.raises(ConfigError) as refused:
        read(folder, PLANT, RECIPES.replace("BODY", body))
    (problem,) = refused.value.problems
    return problem.removeprefix(f"{folder}/recipes.py:7:1: go cannot be built: ")


@pytest.mark.parametrize(("body", "said"), CALLS.items(), ids=CALLS)
def test_a_call_that_does_not_fit_is_told_with_what_the_step_takes(
    tmp_path: Path, body: str, said: str
) -> None:
    assert refusal(tmp_path, body) == said


def test_a_call_of_other_code_is_told_as_python_says_it(tmp_path: Path) -> None:
    assert refusal(tmp_path, "len()") == "TypeError: len() takes exactly one argument (0 given)"


class Loader(Offers):
    def __str__(self) -> str:
        return "loader"

    def home(self) -> None: ...

    def visit(self) -> None: ...


def test_a_misspelled_step_is_told_with_the_steps_that_there_are() -> None:
    loader: Any = Loader()
    with pytest.raises(AttributeError) as error:
        loader.hom()
    assert misspelled(error.value) == "loader has no step 'hom'; there are home, visit; did you mean home?"


def test_an_error_about_anything_else_keeps_its_own_words() -> None:
    text: Any = ""
    with pytest.raises(AttributeError) as error:
        text.hom()
    assert misspelled(error.value) is None
