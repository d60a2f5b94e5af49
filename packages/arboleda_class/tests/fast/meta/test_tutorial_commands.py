"""Lessons have the commands of the tutorial."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.tutorial_pages import LEFT_OUT, commands, pages

from arboleda_class.lessons import said


@pytest.mark.parametrize("page", pages("es"), ids=lambda page: page.stem)
def test_a_spanish_page_shows_what_its_lesson_prints(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARBOLEDA_LANG", "es")
    english = commands(page.with_name(page.name.replace(".es.md", ".md")))
    for (command, expected), (typed, printed) in zip(english, commands(page), strict=True):
        assert typed == command
        if "examples/" in command and ".venv/bin/python" in command:
            spoken = [said(line) for line in expected if LEFT_OUT not in line]
            assert [line for line in printed if LEFT_OUT not in line] == spoken
