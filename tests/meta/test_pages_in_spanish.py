"""A page for whoever stands at a cell, teaches or learns is there in Spanish, too, and says the same.

Any other page for users has one line in Spanish, that it is in English.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from arboleda.dashboard.findings import findings
from arboleda.dashboard.wording import words
from arboleda.web.languages import contents

from ..documents import BOXES, ENGLISH, boxes, links

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs/how-to"
AT_A_CELL = ("operate", "page", "send-a-task", "failed-at-night", "two-arms", "real-boards", "make-a-board")
MAKING = ("add-a-device", "write-a-recipe", "plant-file")
LEARNING = ("teach", "teach-a-class", "teach-the-lessons", "exercises", "playground", "original-description")
HOW_TOS = [f"docs/how-to/{name}" for name in (*AT_A_CELL, *MAKING, *LEARNING)]
PAGES = [*HOW_TOS, "docs/reference/topics", "docs/safety", "docs/scope"]
OF_A_PROGRAM = ("api", "proof")  # pages of the reference that are made from code
IN_ENGLISH = [
    page
    for folder in (FOLDER, ROOT / "docs/reference")
    for page in sorted(folder.glob("*.md"))
    if not page.name.endswith(".es.md")
    and not page.with_suffix(".es.md").exists()
    and page.stem not in OF_A_PROGRAM
]
COMMENT = re.compile(
    r"(?:^|\s+)(?:#|//)\s.*|(?<=\S) {3,}\S.*|^\s*state \".*|: \w+( \w+)+$"
)  # as a word of a diagram
WORDS = re.compile(r"`([^`\n]+)`")
LABEL = re.compile(r"(?<![*\w])\*([^*\n]+)\*(?![*\w])")
TYPED = re.compile(r"(?:arboleda|curl|make|pip|podman|python|ros2|sudo|\.venv/\S+) ")


def both(page: str) -> tuple[str, str]:
    english, spanish = ((ROOT / f"{page}{ending}").read_text("utf-8") for ending in (".md", ".es.md"))
    return english, spanish


def shape(text: str) -> list[str]:
    """Its headings, rows of tables and points of lists, without their words."""
    return re.findall(r"^(#+ |\||- |\d+\. )", BOXES.sub("", text), re.MULTILINE)


def code(text: str) -> list[tuple[str, list[str]]]:
    """Its boxes without comments; of what a terminal shows only the lines that no language says otherwise."""
    return [(kind, [COMMENT.sub("", line) for line in box.splitlines()]) for kind, box in boxes(text)]


def is_said(line: str, spanish: str) -> bool:
    """True for an English line that the catalogue has whole in Spanish."""
    return bool(ENGLISH.search(line)) and not ENGLISH.search(spanish)


def test_these_pages_and_no_others_are_in_spanish() -> None:
    written = {page.relative_to(ROOT).as_posix() for page in FOLDER.glob("*.es.md")}
    assert written == {f"{page}.es.md" for page in HOW_TOS}


@pytest.mark.parametrize("page", IN_ENGLISH, ids=lambda page: page.stem)
def test_a_page_in_english_says_so_in_spanish_below_its_title(page: Path) -> None:
    title, _, line, *_ = page.read_text("utf-8").splitlines()
    assert title.startswith("# ") and re.fullmatch(r"\*\w.+: esta página está en inglés\.\*", line)


@pytest.mark.parametrize("page", PAGES)
def test_both_languages_have_the_same_parts_and_links(page: str) -> None:
    english, spanish = both(page)
    assert shape(english) and shape(spanish) == shape(english)
    assert links(ROOT / f"{page}.es.md") == links(ROOT / f"{page}.md")


@pytest.mark.parametrize("page", PAGES)
def test_a_box_has_the_same_code_and_what_a_terminal_says_in_spanish(page: str) -> None:
    english, spanish = (code(text) for text in both(page))
    assert [kind for kind, _ in spanish] == [kind for kind, _ in english]
    said = findings("es")
    for (kind, ours), (_, theirs) in zip(spanish, english, strict=True):
        if kind:
            assert ours == theirs
        else:
            assert [line for line in theirs if TYPED.match(line) and line not in ours] == []
            assert [line for line in ours if line in theirs and is_said(line, said(line))] == []


@pytest.mark.parametrize("page", PAGES)
def test_both_languages_name_the_same_keys_and_files(page: str) -> None:
    english, spanish = (set(WORDS.findall(BOXES.sub("", text))) for text in both(page))
    others = {
        word for word in english ^ spanish if " " not in word
    }  # those with blanks are sentences of the plant
    assert {word for word in others if not word.startswith("NotSent(")} == set()
    assert [word for word in spanish - english if ENGLISH.search(word)] == []


@pytest.mark.parametrize("page", PAGES)
def test_labels_are_those_of_the_page(page: str) -> None:
    ours, theirs = (
        words(each).flat | {f"workbook.{key}": text for key, text in contents(each, "workbook").items()}
        for each in ("es", "en")
    )
    labels: dict[str, set[str]] = {}
    for key, text in theirs.items():
        labels.setdefault(text, set()).add(ours.get(key, text))
    english, spanish = (LABEL.findall(BOXES.sub("", text)) for text in both(page))
    named = {label for label in english if label in labels}
    assert [(label, labels[label]) for label in named if not labels[label] & {*spanish}] == []


@pytest.mark.parametrize("page", PAGES)
def test_each_leads_to_the_other(page: str) -> None:
    english, spanish = both(page)
    name = Path(page).name
    assert f"]({name}.es.md)" in english and f"]({name}.md)" in spanish


@pytest.mark.parametrize("page", sorted(FOLDER.glob("*.md")), ids=lambda page: page.name)
def test_a_title_says_what_a_person_does(page: Path) -> None:
    title = re.match(r"# (\w+) \S", page.read_text("utf-8"))
    assert title is not None
    if page.name.endswith(".es.md"):
        assert title[1].endswith(("ar", "er", "ir"))
    else:
        assert title[1] not in ("How", "A", "The", "From", "My")
