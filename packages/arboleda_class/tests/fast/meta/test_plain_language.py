"""Screens of this package are easy to read: no sentence of them is long."""

from __future__ import annotations

import pytest
from tests.meta.test_plain_language import long_ones

from arboleda.web.languages import LANGUAGES


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("part", ["playground", "workbook"])
def test_a_screen_has_no_long_sentence(part: str, language: str) -> None:
    assert long_ones(part, language) == []
