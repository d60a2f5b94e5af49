"""The language of the terminal: which one, and what is said in it, by a plant over HTTP, too."""

from __future__ import annotations

import pytest
import typer.testing

from arboleda.cli.language import VARIABLES, language, say_in
from arboleda.cli.main import cli
from arboleda.cli.screen import says
from arboleda.cli.status import spoken
from arboleda.model import text
from arboleda.model.errors import TextError
from arboleda.testing import shipped


@pytest.fixture
def spanish(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ({"ARBOLEDA_LANG": "es"}, "es"),
        ({"LANG": "es_CO.UTF-8"}, "es"),
        ({"LC_ALL": "C", "LANG": "es_ES.UTF-8"}, "en"),
        ({"LC_MESSAGES": "es_ES.UTF-8", "LANG": "en_US.UTF-8"}, "es"),
        ({"ARBOLEDA_LANG": "en", "LANG": "es_ES.UTF-8"}, "en"),
        ({"ARBOLEDA_LANG": "fr"}, "en"),
        ({}, "en"),
    ],
)
def test_the_first_variable_that_is_set_says_the_language(
    monkeypatch: pytest.MonkeyPatch, given: dict[str, str], wanted: str
) -> None:
    for name in VARIABLES:
        monkeypatch.delenv(name, raising=False)
    for name, value in given.items():
        monkeypatch.setenv(name, value)
    assert language() == wanted


def test_the_overview_is_in_the_language(spanish: None) -> None:
    shown = typer.testing.CliRunner().invoke(cli, ["--help"]).output
    words = " ".join(shown.split())
    assert "Maneja celdas de robots" in words
    assert "Comandos:" in words and "Da una tarea a la planta en marcha" in words
    shown = typer.testing.CliRunner().invoke(cli, ["help", "operate"]).output
    words = " ".join(shown.split())
    assert words.startswith("Operarla:") and "Lleva un robot a su referencia." in words


def test_facts_that_every_arm_has_are_named_in_it(spanish: None) -> None:
    robot = {"q": None, "node": None, "facts": {"effector": False, "piece": True, "door": "open"}}
    assert says(robot) == "efector apagado, pieza sí, door open"


def test_the_form_of_a_task_is_said_in_this_language() -> None:
    with pytest.raises(TextError) as refused:
        text.parse("", shipped())
    form = "<una celda> <un camino> <una estación>, p. ej. sis_a 0A 8, o <un brazo o una celda> palletizing"
    assert say_in("es", refused.value.sentence) == f"la tarea está vacía; escriba {form}"


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
