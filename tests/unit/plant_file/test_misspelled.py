"""Sentences for steps that a recipe misspells."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.recipes.errors import Offers, misspelled


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
