"""A state of a cell has one word in English and one in Spanish, on every screen and in the docs."""

from __future__ import annotations

import io
import re
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

import pytest
from rich.console import Console

import arboleda.core
from arboleda.cli.screen import table
from arboleda.client.answers.plant import Cell
from arboleda.dashboard.wording import LANGUAGES, SENTENCES, tree_of, words
from arboleda.model.cell_states import CellState
from arboleda.model.sentence import Phrase
from arboleda.testing import Rig, shipped
from arboleda.views import view
from arboleda.web.schema.answers import model_of

ROOT = Path(__file__).parents[2]
STANDINGS = ("blocked", "paused")
# A phrase that says the state of a cell, "{cell} is held ({why}); {next}".
SAYS_STATE = re.compile(rf"\{{cell\}} is ({'|'.join(state.value for state in CellState)})\b")
OTHER_WORDS = (
    "bloqueada",
    "liberada",
    "liberándose",
    "parándose",
    "detenida",
    "cleared",
    "halting",
    "stopping",
)


def in_docs() -> dict[str, str]:
    """The Spanish word of each English one, as the table of the operators' page has them."""
    page = (ROOT / "docs/how-to/operate.md").read_text(encoding="utf-8")
    section = page.partition("## The words for a cell\n")[2].partition("\n## ")[0]
    rows: list[tuple[str, str]] = re.findall(r"^\| `(\w+)` \| ([^|]+) \|", section, re.MULTILINE)
    assert len(rows) == len(dict(rows)), "a word stands there twice"
    return dict(rows)


def on_page(language: str) -> dict[str, str]:
    return {state.value: words(language)(f"cell_state.{state.value}") for state in CellState}


def test_the_docs_have_each_word_once() -> None:
    assert in_docs() == on_page("es")


def test_the_page_says_the_words_of_the_api() -> None:
    assert on_page("en") == {state.value: state.value for state in CellState}
    assert model_of(Cell).model_fields["state"].annotation is CellState


def test_the_message_on_ros_2_lists_the_words() -> None:
    message = (ROOT / "src/arboleda_interfaces/msg/CellState.msg").read_text(encoding="utf-8")
    (line,) = (line for line in message.splitlines() if line.startswith("string state "))
    assert line.partition("PackML word: ")[2].split() == [state.value for state in CellState]


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_two_states_share_a_word(language: str) -> None:
    assert len(set(on_page(language).values())) == len(CellState)


@pytest.mark.parametrize("language", LANGUAGES)
def test_an_idle_cell_that_cannot_work_is_called_idle(language: str) -> None:
    said = words(language)
    assert all(said(f"cell_state.{each}").startswith(f"{said('cell_state.idle')}, ") for each in STANDINGS)


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("state", CellState)
def test_what_stands_beside_a_state_begins_with_its_word_or_the_cell(state: CellState, language: str) -> None:
    told = tree_of(language)["next"].get(state.value)
    if told is None:
        assert state in (CellState.IDLE, CellState.EXECUTE)
        return
    word = words(language).cell(state.value)
    assert told.lower().startswith(f"{word}: ")


@pytest.mark.parametrize("state", CellState)
@pytest.mark.parametrize("language", LANGUAGES)
def test_the_plants_sentences_have_the_word_of_the_page(state: CellState, language: str) -> None:
    assert words(language).say(state.sentence) == words(language).cell(state.value)


def test_a_sentence_about_a_state_has_its_word_and_no_other_in_spanish() -> None:
    spanish, found = on_page("es"), set()
    names = [each.name for each in walk_packages(arboleda.core.__path__, "arboleda.core.")]
    for phrase in (each for name in names for each in vars(import_module(name)).values()):
        if isinstance(phrase, Phrase) and (state := SAYS_STATE.match(phrase.english)):
            found.add(state[1])
            ours = tree_of("es")[SENTENCES][phrase.key]
            said = {word for word in (*spanish.values(), *OTHER_WORDS) if re.search(rf"\b{word}\b", ours)}
            assert said == {spanish[state[1]]}, phrase
    assert found == {"held", "idle"}


def test_the_terminal_says_the_words_of_the_api() -> None:
    snapshot = Rig(shipped()).snapshot()
    for state in CellState:
        assert (
            drawn_state({**snapshot["cells"][0], "state": state.value, "not_ready": None}, snapshot) == state
        )
    blocked = {**snapshot["cells"][0], "not_ready": "ra1 is offline", "advice": []}
    assert drawn_state(blocked, snapshot) == f"idle, {view.standing(blocked)}" == "idle, blocked"


def drawn_state(cell: dict[str, Any], snapshot: dict[str, Any]) -> str:
    """What stands under `state` in the row of the first cell."""
    console = Console(file=io.StringIO(), width=120)
    console.print(table({**snapshot, "cells": [cell, *snapshot["cells"][1:]]}))
    lines = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
    heading = next(line for line in lines if line.split()[:2] == ["cell", "state"])
    row = next(line for line in lines if line.split()[:1] == [cell["name"]])
    return str(row[heading.index("state") : heading.index("task")].strip())
