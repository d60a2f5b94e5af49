"""Task texts that the fields of goals and requests spell."""

from __future__ import annotations

import pytest

from arboleda.model.errors import TextError
from arboleda.model.text import parse
from arboleda.testing import shipped
from arboleda_ros.typed.fields import compose

SHIPPED = shipped()


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"text": " sis_a 0B 7 #lot42 "}, "sis_a 0B 7 #lot42"),
        ({"text": "sis_a 0B 7", "id": "lot42"}, "sis_a 0B 7 #lot42"),
        ({"cell": "sis_a", "path": "0B", "station": "7"}, "sis_a 0B 7"),
        ({"cell": "sis_a", "recipe": "Storage", "path": "0B", "station": "7", "id": "#b"}, "sis_a 0B 7 #b"),
        ({"cell": "ra1", "recipe": "palletizing"}, "ra1 palletizing"),
        ({}, ""),
    ],
    ids=["text", "text and id", "storage", "storage by name", "palletizing", "nothing"],
)
def test_fields_spell_a_text(fields: dict[str, str], text: str) -> None:
    assert compose(**fields) == text


@pytest.mark.parametrize(
    ("fields", "names"),
    [
        ({}, ["empty"]),
        ({"cell": "sis_a", "path": "0B"}, ["2 words"]),
        ({"cell": "sis_a", "station": "7"}, ["'7' is neither a path of sis_a"]),
        ({"cell": "sis_a", "recipe": "sorting"}, ["'sorting'", "palletizing"]),
        ({"cell": "sis_a", "recipe": "palletizing", "path": "0B", "station": "7"}, ["4 words"]),
        ({"text": "sis_a 0B 7", "cell": "sis_b", "path": "0C", "station": "1"}, ["6 words"]),
        ({"cell": "sis_a", "path": "0B", "station": "7 #a", "id": "b"}, ["4 words"]),
    ],
    ids=["nothing", "no station", "no path", "recipe", "surplus fields", "text and fields", "two ids"],
)
def test_wrong_fields_are_refused_like_a_wrong_text(fields: dict[str, str], names: list[str]) -> None:
    with pytest.raises(TextError) as refusal:
        parse(compose(**fields), SHIPPED)
    for name in names:
        assert name in str(refusal.value)
