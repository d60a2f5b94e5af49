"""What users read is plain, in English and in Spanish: short sentences, one language, one safety sentence."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.packages import PACKAGES

from arboleda.dashboard.wording import flat
from arboleda.web.languages import contents

from ..documents import ENGLISH

ROOT = Path(__file__).parents[2]
NOT_FOR_USERS = ("ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md")
PAGES = sorted(
    page.relative_to(ROOT).as_posix()
    for folder in (
        "docs",
        "docs/tutorial",
        "docs/how-to",
        "docs/examples",
        "docs/reference",
        "firmware/esp32",
        ".",
    )
    for page in (ROOT / folder).glob("*.md")
    if page.name not in NOT_FOR_USERS
)
SPANISH = [page for page in PAGES if page.endswith(".es.md")]
LANGUAGES = ROOT / "src/arboleda/arboleda/web/languages"
TEXTS = ("page", "login", "nodes")
MOST = 40  # words of a sentence
LONGER = {
    "docs/reference/proof.md": 1
}  # sentences of a page that are longer still: mend one, and lower the number
BOX = re.compile(r"^```.*?^```$|^    .*$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`|\]\([^)]*\)|<[^>\n]*>|https?://\S+")
NAMED = re.compile(r"(?<![*\w])\*[^*\n]+\*(?!\w)|«[^»\n]*»|\"[^\"\n]*\"|\[[^\]\n]*\](?=\(http)")
ITEM = re.compile(r"^\s*(?:[-*]|\d+\.) ")
END = re.compile(r"(?<=[.!?])[*)\"»\]]*\s+|(?<=:)\s+(?=[A-ZÁÉÍÓÚÑ¿¡*`\[\"«(])")
WORD = re.compile(r"\w[\w'’-]*")
SAFETY = {
    "es": (
        r"El paro \(software\) no es una función de seguridad\.",
        " Hace falta un pulsador cableado con enclavamiento que corte la alimentación de los motores.",
    ),
    "en": (
        r"Stop \(software\) is not a safety function\.",
        " A hard-wired latching button that removes motor power is required",
    ),
}


def paragraphs(markdown: str) -> Iterator[str]:
    """The paragraphs, points, cells and headings of a page, each as one line, without its code."""
    lines: list[str] = []
    for line in (*CODE.sub("X", BOX.sub("", markdown)).splitlines(), ""):
        begins_anew = not line.strip() or line[0] in "|#" or ITEM.match(line)
        if begins_anew and lines:
            yield " ".join(lines)
            lines = []
        if line.startswith("|"):
            yield from (cell.strip() for cell in line.split("|"))
        elif line.strip():
            lines.append(ITEM.sub("", line).strip())


def long_sentences(text: str) -> list[str]:
    return [each for each in END.split(text) if len(WORD.findall(each)) > MOST]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_has_no_long_sentence(page: str) -> None:
    text = (ROOT / page).read_text("utf-8")
    long = [each for paragraph in paragraphs(text) for each in long_sentences(paragraph)]
    assert len(long) <= LONGER.get(page, 0), long


def long_ones(part: str, language: str) -> list[str]:
    """The long sentences of a part of a language, as the page."""
    texts = flat(contents(language, part))
    assert texts
    return [
        each for text in texts.values() for line in str(text).splitlines() for each in long_sentences(line)
    ]


@pytest.mark.parametrize("language", ["en", "es"])
@pytest.mark.parametrize("part", TEXTS)
def test_a_screen_has_no_long_sentence(part: str, language: str) -> None:
    assert long_ones(part, language) == []


@pytest.mark.parametrize("page", SPANISH)
def test_a_spanish_page_has_no_english_outside_of_code(page: str) -> None:
    text = re.sub(r"^\*In English: .*\*$", "", (ROOT / page).read_text("utf-8"), flags=re.MULTILINE)
    prose = [NAMED.sub("", paragraph) for paragraph in paragraphs(text)]
    assert [line for line in prose if ENGLISH.search(line)] == []


def read_by_users() -> Iterator[tuple[str, str]]:
    files = [ROOT / page for page in PAGES]
    folders = (LANGUAGES, *(code / "languages" for code in PACKAGES.values()))
    files += [file for folder in folders for file in sorted(folder.glob("*/*.yaml"))]
    for file in files:
        spanish = file.name.endswith(".es.md") or file.parent.name == "es"
        yield "es" if spanish else "en", " ".join(file.read_text("utf-8").split())


@pytest.mark.parametrize("language", SAFETY)
def test_the_safety_sentence_is_said_word_for_word(language: str) -> None:
    begins, goes_on = SAFETY[language]
    texts = [text for of, text in read_by_users() if of == language]
    rest = [
        text[each.end() : each.end() + len(goes_on)] for text in texts for each in re.finditer(begins, text)
    ]
    assert len(rest) >= 5
    assert [each for each in rest if each != goes_on] == []


def test_nothing_in_spanish_calls_the_stop_a_stop_by_software() -> None:
    assert [text[:60] for of, text in read_by_users() if of == "es" and "paro por software no" in text] == []


def test_long_sentences_and_english_are_found() -> None:
    words = "word " * MOST
    page = f"# A\n\n{words}\nmore. Short.\n\n- {words}more\n\n```\n{words}more\n```\n| {words}`and` | x |\n"
    found = [each for paragraph in paragraphs(page) for each in long_sentences(paragraph)]
    assert len(found) == 3 and found[0].endswith("more.")
    assert ENGLISH.search("con la placa y the plant") and not ENGLISH.search("con la placa y el brazo")
