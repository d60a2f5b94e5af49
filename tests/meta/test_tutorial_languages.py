"""The tutorial says the same in both languages, and leaves no example out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ..documents import BOXES, boxes, links

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "tutorial"
LESSONS = sorted(path.stem for path in (ROOT / "examples").glob("[0-9][0-9]_*.py"))
PAGES = ["README", *LESSONS]


def read(page: str, ending: str) -> str:
    return (FOLDER / f"{page}{ending}").read_text("utf-8")


def headings(text: str) -> list[str]:
    return re.findall(r"^(#+) ", BOXES.sub("", text), re.MULTILINE)


def boxes_with_code(text: str) -> list[tuple[str, str]]:
    """Those of a kind; the words of a plain box may be translated."""
    return [(kind, content) for kind, content in boxes(text) if kind]


def test_there_are_sixteen_lessons_with_a_page_each() -> None:
    assert [name[:2] for name in LESSONS] == [f"{number:02}" for number in range(1, 17)]
    found = {path.name for path in FOLDER.iterdir()}
    assert found == {f"{page}{ending}" for page in PAGES for ending in (".md", ".es.md")}


@pytest.mark.parametrize("page", PAGES)
def test_both_languages_have_the_same_headings_and_commands(page: str) -> None:
    english, spanish = read(page, ".md"), read(page, ".es.md")
    assert headings(english)
    assert headings(spanish) == headings(english)
    assert boxes_with_code(spanish) == boxes_with_code(english)
    assert links(FOLDER / f"{page}.es.md") == links(FOLDER / f"{page}.md")


@pytest.mark.parametrize("lesson", LESSONS)
def test_a_page_runs_its_example(lesson: str) -> None:
    commands = [content for kind, content in boxes_with_code(read(lesson, ".md")) if kind == "console"]
    assert any(f"$ .venv/bin/python examples/{lesson}.py" in content for content in commands)


def test_the_index_names_every_example() -> None:
    assert re.findall(r"`examples/(\w+)\.py`", read("README", ".md")) == LESSONS
