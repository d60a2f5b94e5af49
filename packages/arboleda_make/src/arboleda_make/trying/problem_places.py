"""Place in a plant file that a problem of it names."""

from __future__ import annotations

import re

PLACED = re.compile(r"(?:[^:\n]+:\d+:\d+: )?(?P<said>(?:(?P<place>[^\s:]+): )?.*)", re.DOTALL)


def placed(problem: str) -> tuple[str, str]:
    """The place, as `kinds.lamp.verbs.shine`, "" for none, and the sentence without the line of its file."""
    match = PLACED.fullmatch(problem)
    assert match is not None  # it takes any text
    return match["place"] or "", match["said"]


def is_at(place: str, other: str) -> bool:
    """True if a place is another one, or in it."""
    return place == other or place.startswith((f"{other}.", f"{other}["))
