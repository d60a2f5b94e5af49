"""Every how-to page is there in Spanish, too, and says there what it says in English."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ..documents import BOXES, boxes, links

FOLDER = Path(__file__).parents[2] / "docs/how-to"
PAGES = sorted(path.name.removesuffix(".es.md") for path in FOLDER.glob("*.es.md"))
WORDS = re.compile(r"`([^`\n]+)`")


def both(page: str) -> tuple[str, str]:
    english, spanish = ((FOLDER / f"{page}{ending}").read_text("utf-8") for ending in (".md", ".es.md"))
    return english, spanish


def shape(text: str) -> list[str]:
    """Its headings, rows of tables and points of lists, without their words."""
    return re.findall(r"^(#+ |\||- |\d\. )", BOXES.sub("", text), re.MULTILINE)


def test_every_page_is_there_in_both_languages() -> None:
    written = {path.name.removesuffix(".md").removesuffix(".es") for path in FOLDER.glob("*.md")}
    assert set(PAGES) == written


@pytest.mark.parametrize("page", PAGES)
def test_both_languages_have_the_same_parts_code_and_links(page: str) -> None:
    english, spanish = both(page)
    assert shape(english) and shape(spanish) == shape(english)
    assert boxes(spanish) == boxes(english)
    assert links(FOLDER / f"{page}.es.md") == links(FOLDER / f"{page}.md")


@pytest.mark.parametrize("page", PAGES)
def test_both_languages_name_the_same_keys_and_files(page: str) -> None:
    english, spanish = (set(WORDS.findall(BOXES.sub("", text))) for text in both(page))
    assert {word for word in english ^ spanish if not word.startswith("NotSent(")} == set()


@pytest.mark.parametrize("page", PAGES)
def test_each_leads_to_the_other(page: str) -> None:
    english, spanish = both(page)
    assert f"]({page}.es.md)" in english and f"]({page}.md)" in spanish


@pytest.mark.parametrize("page", PAGES)
def test_a_title_says_what_a_person_does(page: str) -> None:
    english, spanish = (re.match(r"# (\w+) \S", text) for text in both(page))
    assert english is not None and english[1] not in ("How", "A", "The", "From", "My")
    assert spanish is not None and spanish[1].endswith(("ar", "er", "ir"))
