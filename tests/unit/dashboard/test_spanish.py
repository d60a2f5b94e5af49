"""The page's Spanish: one word for one thing, usted everywhere, and no English that we have a word for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.dashboard.wording import flat, tree_of, words
from arboleda.recipes.authoring import IS, WAIT
from arboleda.recipes.decorators import INVERT, REPEAT, RETRY, TIMEOUT, TRY
from arboleda.recipes.handles import DOING

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
