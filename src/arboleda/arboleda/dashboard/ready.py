"""Way out of the trouble of a cell: one button for all of it, and the single acts behind "More"."""

from __future__ import annotations

from .tags import rows, tag
from .wording import Words


def build(cell: str, words: Words) -> None:
    """Draw the button of a cell, and the list of its advice."""
    rows(f"ready.{cell}", ["", ""], classes="ways")
    with tag("details", classes="more"):
        tag("summary", words("ready.more"))
        rows(f"ways.{cell}", ["", ""], classes="ways")
