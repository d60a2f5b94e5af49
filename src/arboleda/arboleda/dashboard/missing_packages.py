"""Packages that add to the page and are not installed: what they are for, and the line that installs each."""

from __future__ import annotations

from arboleda.model.packages import FLEET, MAKE, MISSING, PROOFS
from arboleda.model.sentence import Phrase

from .added import installed
from .tags import tag
from .wording import Words

WHAT = {
    FLEET: Phrase("package.oee", "The OEE of the cells"),
    MAKE: Phrase("package.changing", "Changing and teaching this plant"),
    PROOFS: Phrase("package.reporting", "Reporting failures and provoking faults"),
}


def build(words: Words) -> None:
    """Draw a line on the packages that are missing; nothing where all are there."""
    there = installed()
    said = [
        words.say(MISSING(what=what(), package=package))
        for package, what in WHAT.items()
        if package not in there
    ]
    if said:
        tag("p", ". ".join(said), classes="hint")
