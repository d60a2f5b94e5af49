"""What the plant can say, and the page's catalogues of it."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
from collections import Counter
from collections.abc import Iterator
from string import Formatter
from types import ModuleType
from typing import Any

import pytest
from tests.packages import PACKAGES

import arboleda
import arboleda.dashboard.toolkit  # its library starts a process as it is imported, and no test here may
from arboleda.dashboard.wording import LANGUAGES, tree_of, words
from arboleda.model.sentence import Phrase, Sentence
from arboleda_proofs.simulator.mishaps import Mishap

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
OTHERS = LANGUAGES[1:]


def modules() -> Iterator[ModuleType]:
    for name in (*(f"arboleda.{room}" for room in TOLD_BY), *PACKAGES):
        package = importlib.import_module(name)
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield importlib.import_module(found.name)


def phrases_in(value: Any) -> Iterator[Phrase]:
    if isinstance(value, Phrase):
        yield value
    elif isinstance(value, Sentence | Mishap):
        yield value.phrase
    elif isinstance(value, dict | tuple):
        for each in value.values() if isinstance(value, dict) else value:
            yield from phrases_in(each)


def phrases() -> dict[str, Phrase]:
    """Every phrase that a module of ours names, by its key."""
    found = {id(phrase): phrase for module in modules() for phrase in phrases_in(vars(module))}
    twice = [key for key, count in Counter(each.key for each in found.values()).items() if count > 1]
    assert twice == [], "one key, one phrase"
    return {phrase.key: phrase for phrase in found.values()}


def slots(text: str) -> set[str]:
    return {field for _, field, _, _ in Formatter().parse(text) if field is not None}


def test_there_are_phrases() -> None:
    assert arboleda.__name__ and len(phrases()) > 150


@pytest.mark.parametrize("language", OTHERS)
def test_a_catalogue_has_every_phrase_and_no_other(language: str) -> None:
    assert tree_of(language)["sentences"].keys() == phrases().keys()


@pytest.mark.parametrize("language", OTHERS)
def test_a_catalogue_fills_the_slots_of_its_phrases(language: str) -> None:
    said = tree_of(language)["sentences"]
    english = {key: slots(phrase.english) for key, phrase in phrases().items()}
    assert {key: slots(said[key]) for key in said} == english


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
