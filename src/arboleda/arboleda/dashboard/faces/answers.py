"""Rows of the answers that devices and people gave to a task."""

from __future__ import annotations

from typing import Any

from ..wording import Words
from . import Face
from .links import value_words

Row = dict[str, Any]


def rows(words: Words, name: str, answers: list[Row], most: int | None = None) -> Face:
    """A list of answers under this name, in their order; at most the `most` last ones."""
    numbered = [*enumerate(answers)][-most if most else 0 :]
    found: Face = {f"rows/{name}": [str(number) for number, _ in numbered]}
    for number, each in numbered:
        texts = [each["by"], each["asked"], value_words(words, each["answer"])]
        found[f"row/{name}/{number}"] = {"state": "", "texts": texts}
    return found
