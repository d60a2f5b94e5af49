"""What the plant can say, and the page's catalogues of it; its Spanish: one word for one thing, and usted."""

from __future__ import annotations

import ast
import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path
from string import Formatter
from types import ModuleType

import pytest
from tests.packages import PACKAGES

from arboleda.dashboard import toolkit as toolkit  # to import it starts a process, which no test may
from arboleda.dashboard.wording import flat, tree_of, words
from arboleda.model.sentence import Phrase
from arboleda.recipes.authoring import IS, WAIT
from arboleda.recipes.decorators import INVERT, REPEAT, RETRY, TIMEOUT, TRY
from arboleda.recipes.handles import DOING

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


ROOT = Path(__file__).parents[3]
MIXED = {
    "archivo, not fichero": r"(?i)\bficheros?\b",
    "a reposo, not a casa": r"\ba casa\b",
    "estación, not puesto of a cell": r"\bpuesto (?:de )?\{(?:cell|station)\}",
    "usted, not tú": r"(?i)(?:^|[.:;,¿(] ?)(?:mira|prueba|escribe|pulsa|elige|usa|haz|pon)"
    r" (?:`|dentro|antes|después|el |la |los |las |un |una |si )",
    "la que la termine antes, in this order": r"\bque antes la termine\b|\bque termine antes\b",
}


def sentences() -> dict[str, str]:
    return {key: str(text) for key, text in flat(tree_of("es")).items()}


def documents() -> dict[str, str]:
    files = [ROOT / "README.es.md", *(ROOT / "docs").rglob("*.es.md")]
    return {str(file.relative_to(ROOT)): file.read_text("utf-8") for file in files}


@pytest.mark.parametrize("pattern", MIXED.values(), ids=MIXED)
def test_the_page_has_one_word_for_one_thing(pattern: str) -> None:
    assert {key: text for key, text in sentences().items() if re.search(pattern, text)} == {}


@pytest.mark.parametrize("name", [name for name in MIXED if not name.startswith("usted")])
def test_so_do_the_documents(name: str) -> None:
    assert [file for file, text in documents().items() if re.search(MIXED[name], text)] == []


@pytest.mark.parametrize(
    ("name", "wrong", "right"),
    [
        ("archivo, not fichero", "el Fichero de la planta", "el archivo de la planta"),
        ("a reposo, not a casa", "ir a casa", "ir a reposo"),
        ("estación, not puesto of a cell", "en el puesto {station} de {cell}", "supuesto de {cell}"),
        ("usted, not tú", "otro archivo: mira `arboleda logs`", "otro archivo: mire `arboleda logs`"),
        ("usted, not tú", "aún no; prueba dentro de unos segundos", "una prueba dentro de la página"),
        ("la que la termine antes, in this order", "la que antes la termine", "la que la termine antes"),
    ],
)
def test_the_patterns_find_what_they_are_for(name: str, wrong: str, right: str) -> None:
    assert re.search(MIXED[name], wrong)
    assert not re.search(MIXED[name], right)


def test_no_two_parts_of_the_page_have_one_name() -> None:
    said = sentences()
    names = [text.lower() for key, text in said.items() if key.startswith("tab.")]
    assert len(set(names)) == len(names)
    assert said["tab.events"].lower() not in said["tasks.list"].lower()


def test_steps_and_orders_of_own_kinds_are_said_in_spanish() -> None:
    spanish = words("es")
    assert spanish.say(DOING(order="clamp false")) == "con la orden «clamp false»"
    assert spanish.say(IS(answer="unsure")) == "si la respuesta es unsure"
    for phrase in (RETRY, REPEAT, TIMEOUT, TRY, INVERT):
        assert spanish.say(phrase(step=WAIT())).endswith(": esperar")
