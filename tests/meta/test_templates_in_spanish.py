"""What is found is whole in Spanish: each template with values in it, and the names of faults."""

from __future__ import annotations

import re
from collections.abc import Iterator
from string import Formatter

import pytest
from tests.documents import ENGLISH

from arboleda.dashboard.findings import findings
from arboleda.dashboard.wording import REASONS, words
from arboleda.web.languages import contents
from arboleda.web.languages.templates import FEW, Template

OF_DEVICES: dict[str, str] = contents("es", REASONS)
ROWS: dict[str, str] = contents("es", "findings")["sentences"] | OF_DEVICES
NAME, PART = ("10.0.0.7:502",) * 2, ("3 runs", "3 ejecuciones")  # any word; a part that is a template itself
QUOTED = re.compile(r"[\"'`]\{")
NO_SENTENCE = re.compile(r"`[^`]*`|\"[^\"]*\"|'[^']*'|<[^>]*>|\{[^}]*\}|--[\w-]+")


def filled(text: str, value: str) -> str:
    pieces = Formatter().parse(text)
    return "".join(f"{literal}{'' if name is None else value}" for literal, name, *_ in pieces)


def slots(text: str) -> int:
    return sum(name is not None for _, name, *_ in Formatter().parse(text))


def unlike(rows: dict[str, str], english: str, spanish: str) -> Iterator[tuple[str, str]]:
    """Each text of these templates with this value in it that is not said by their Spanish."""
    for template, other in rows.items():
        ahead = "sis_a" if template.startswith((" ", ",", ";")) and not template.startswith("  ") else ""
        behind = "sis_a" if template.endswith(" ") else ""
        found = findings("es")(f"{ahead}{filled(template, english)}{behind}")
        if found != f"{ahead}{filled(other, spanish)}{behind}":
            yield template, found


def test_a_template_is_said_whole() -> None:
    assert list(unlike(ROWS, *NAME)) == []


def test_a_template_of_one_value_is_said_with_what_is_said_by_another() -> None:
    rows = {
        each: other
        for each, other in ROWS.items()
        if slots(each) == 1 and Template(each, other).letters >= FEW and not QUOTED.search(each)
    }
    own = {each: other for each, other in rows.items() if each not in OF_DEVICES}
    assert len(own) > 300
    assert list(unlike(own, *PART)) == []


def test_no_spanish_has_an_english_word() -> None:
    texts = {**ROWS, **words("es").flat, **contents("es", "page")["sentences"]}
    plain = {each: NO_SENTENCE.sub("", str(other)) for each, other in texts.items()}
    assert [other for other in plain.values() if ENGLISH.search(other)] == []


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            "95 deg is outside the limits of q2 (q2); allowed: -90 deg to 90 deg",
            "95 grados está fuera de los límites de q2 (q2); se admite: -90 a 90 grados",
        ),
        ("oven is not clear", "oven is not clear"),
    ],
)
def test_a_sentence_of_several_templates_is_whole(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
