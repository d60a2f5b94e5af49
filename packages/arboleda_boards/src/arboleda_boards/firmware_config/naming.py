"""Sentences about names that do not exist."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.plant_file.document import Document, Place, nearest


def unknown(document: Document, place: Place, name: str, known: Iterable[str], what: str) -> None:
    """Keep the problem of an unknown name, with the known ones and the one probably meant."""
    names = list(known)
    there = ", ".join(names) or "none"
    document.problem(place, f'there is no {what} "{name}"{nearest(name, names)}; there are: {there}')
