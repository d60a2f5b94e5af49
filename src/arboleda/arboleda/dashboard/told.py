"""What packages tell people and ask them, below the header of each part of the page."""

from __future__ import annotations

from .tags import rows, tag


def build() -> None:
    """Draw the alarms of packages (the package, the cell, what it says), and what packages ask."""
    with tag("div", classes="told", role="status", aria_live="polite"):
        rows("alarms", ["", "", ""], classes="alarms")
        rows("asks", ["", ""], classes="asks")
