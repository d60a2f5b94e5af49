"""The notebooks of the lessons: the same in both languages, without outputs."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import nbformat
import pytest

FOLDER = Path(__file__).parents[4] / "examples" / "notebooks"
BOOKS = ["lessons_1_to_3", "lessons_4_to_6", "lessons_8_to_10"]
LANGUAGE = ', language="es"'


def read(book: str, ending: str) -> Any:
    return nbformat.read(FOLDER / f"{book}{ending}", as_version=4)


def sources(notebook: Any, kind: str) -> list[str]:
    return [cell.source for cell in notebook.cells if cell.cell_type == kind]


def test_there_is_a_notebook_for_each_three_lessons_but_for_that_of_ros_2() -> None:
    found = {path.name for path in FOLDER.glob("*.ipynb")}
    assert found == {f"{book}{ending}" for book in BOOKS for ending in (".ipynb", ".es.ipynb")}


@pytest.mark.parametrize("book", BOOKS)
def test_outputs_are_not_kept(book: str) -> None:
    for ending in (".ipynb", ".es.ipynb"):
        cells = [cell for cell in read(book, ending).cells if cell.cell_type == "code"]
        assert [cell.outputs for cell in cells] == [[]] * len(cells)
        assert {cell.execution_count for cell in cells} == {None}


@pytest.mark.parametrize("book", BOOKS)
def test_both_languages_run_the_same_and_lead_to_each_other(book: str) -> None:
    english, spanish = read(book, ".ipynb"), read(book, ".es.ipynb")
    assert [cell.cell_type for cell in english.cells] == [cell.cell_type for cell in spanish.cells]
    assert [code.replace(LANGUAGE, "") for code in sources(spanish, "code")] == sources(english, "code")
    assert LANGUAGE in "".join(sources(spanish, "code"))
    texts = ["".join(sources(notebook, "markdown")) for notebook in (english, spanish)]
    headings = [re.findall(r"^(#+) ", text, re.MULTILINE) for text in texts]
    assert headings[0] and headings[0] == headings[1]
    assert f"]({book}.es.ipynb)" in texts[0] and f"]({book}.ipynb)" in texts[1]
    links = [target for text in texts for target in re.findall(r"\]\((\S+?)\)", text)]
    assert [target for target in links if not (FOLDER / target).exists()] == []
