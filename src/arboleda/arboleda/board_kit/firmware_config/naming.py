"""What is said of a name that is not there."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.plant_file.document import Document, Place, nearest


def unknown(document: Document, place: Place, name: str, known: Iterable[str], what: str) -> None:
    """Keeps the problem, with what there is and what may have been meant."""
    names = list(known)
    there = ", ".join(names) or "none"
    document.problem(place, f'there is no {what} "{name}"{nearest(name, names)}; there are: {there}')
