"""What packages tell people, below the header of each part of the page."""

from __future__ import annotations

from .tags import rows, tag


def build() -> None:
    """Draw the alarms of packages: the package, the cell, and what it says."""
    with tag("div", classes="told", role="status", aria_live="polite"):
        rows("alarms", ["", "", ""], classes="alarms")
