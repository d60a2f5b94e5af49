"""What the plant can say, and the page's catalogues of it."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
from collections.abc import Iterator
from string import Formatter
from types import ModuleType

import pytest
from tests.packages import PACKAGES

from arboleda.dashboard import toolkit as toolkit  # to import it starts a process, which no test may
from arboleda.dashboard.wording import words
from arboleda.model.sentence import Phrase

TOLD_BY = (
    "model",
    "dispatch",
    "trees",
    "resume",
    "core",
    "departures",
    "recipes",
    "drivers",
    "views",
    "oee",
    "bt_xml",
    "recorder",
    "wire",
    "runtime",
    "plant_file",
    "dashboard",
    "cli",
)


def modules() -> Iterator[ModuleType]:
    yield importlib.import_module("arboleda_ros.speaker")  # the one there with phrases; others need rclpy
    for name in (*(f"arboleda.{room}" for room in TOLD_BY), *PACKAGES):
        package = importlib.import_module(name)
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield importlib.import_module(found.name)


def slots(text: str) -> set[str]:
    return {field for _, field, _, _ in Formatter().parse(text) if field is not None}


@pytest.mark.long
def test_each_phrase_is_said_with_a_value_for_each_slot() -> None:
    wrong = []
    for module in modules():
        named = {name: value for name, value in vars(module).items() if isinstance(value, Phrase)}
        for call in ast.walk(ast.parse(inspect.getsource(module))):
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in named:
                given = {each.arg for each in call.keywords}
                if given != slots(named[call.func.id].english):
                    wrong.append((module.__name__, call.lineno, call.func.id, given))
    assert wrong == []


def test_a_phrase_of_somebody_else_brings_its_own_words() -> None:
    jammed = Phrase("mill.jammed", "{mill} is jammed", es="{mill} está atascada")
    assert words("es").say(jammed(mill="m1")) == "m1 está atascada"
    assert words("en").say(jammed(mill="m1")) == "m1 is jammed"


def test_a_phrase_that_no_catalogue_knows_is_said_in_english() -> None:
    assert words("es").say(Phrase("mill.open", "{mill} is open")(mill="m1")) == "m1 is open"
