"""Sentences of a plant that come over HTTP, in the language of the terminal."""

from __future__ import annotations

import pytest

from arboleda.cli.status import spoken


@pytest.mark.parametrize(
    ("step", "said"),
    [
        ("drive path 2A", "recorrer el camino 2A"),
        ("move to pick-up A", "ir a la recogida A"),
        ("recovery: at start", "recuperación: en el inicio"),
        ("cools the oven", "cools the oven"),  # of a recipe of somebody's own
    ],
)
def test_the_step_of_a_cell_is_named(step: str, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")
    assert spoken({"cells": [{"name": step, "step": step}]}) == {"cells": [{"name": step, "step": said}]}


@pytest.mark.parametrize(
    ("language", "said"), [("es", "pump está sin conexión; reconectar pump"), ("en", None)]
)
def test_what_keeps_a_cell_is_said_and_names_stay(
    language: str, said: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", language)
    why = "pump is offline; bring pump back"
    told = {"cells": [{"name": why, "not_ready": why, "held_by": None}]}
    assert spoken(told) == {"cells": [{"name": why, "not_ready": said or why, "held_by": None}]}
