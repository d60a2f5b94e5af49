"""Languages: a folder each, with the words of page, nodes, login, waiting room, reports and proofs."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from importlib import resources
from typing import Any

import yaml

FIRST = "en"  # in which is said what another language has no words for


def _found() -> tuple[str, ...]:
    folders = resources.files(__package__).iterdir()
    others = (each.name for each in folders if each.joinpath("page.yaml").is_file() and each.name != FIRST)
    return (FIRST, *sorted(others))


LANGUAGES = _found()


@cache
def contents(language: str, part: str) -> dict[str, Any]:
    """The file of a part of a language: page, nodes, login and so on; without what it does not say."""
    file = resources.files(__package__) / language / f"{part}.yaml"
    found: dict[str, Any] = yaml.safe_load(file.read_text(encoding="utf-8")) if file.is_file() else {}
    return found


@cache
def texts(language: str, part: str) -> dict[str, str]:
    """The words of a part, in English where the language has none."""
    return contents(FIRST, part) | contents(language, part)


def spoken(wishes: Iterable[str | None]) -> str:
    """The first language of these: as addresses, cookies and browsers name it, by its first two letters."""
    words = (each.strip()[:2].lower() for each in wishes if each)
    return next((each for each in words if each in LANGUAGES), FIRST)
