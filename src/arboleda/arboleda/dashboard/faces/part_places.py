"""Places of a cell: how many parts are at each, and what a person may say who put some there or took them."""

from __future__ import annotations

from typing import Any

from arboleda.model.messages import Verb

from ..wording import Words
from . import Face
from .moment import Moment

Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {}
    for cell in moment.snapshot["cells"]:
        if cell["places"]:
            found.update(_of(moment.words, cell))
    return found


def _of(words: Words, cell: Row) -> Face:
    name = cell["name"]
    shown = [place for place in cell["places"] if place["station"] is None or place["parts"]]
    found: Face = {f"rows/places.{name}": [place["name"] for place in shown]}
    for place in shown:
        parts, holds = place["parts"], place["holds"]
        acts = (
            [] if place["by_people"] else [_says(words, name, place, verb) for verb in _useful(parts, holds)]
        )
        found[f"row/places.{name}/{place['name']}"] = {
            "state": "taken" if parts else "free",
            "texts": [place["name"], words("places.parts", parts=parts, holds=holds), _note(words, place)],
            "acts": acts,
        }
    return found


def _useful(parts: int, holds: int) -> list[Verb]:
    """The acts of a person that are of use there."""
    return [*([Verb.LOAD] if parts < holds else []), *([Verb.UNLOAD] if parts else [])]


def _says(words: Words, cell: str, place: Row, verb: Verb) -> Row:
    return {
        "act": verb.value,
        "of": cell,
        "label": words.of("verb", verb.value),
        "does": words(f"places.{verb.value}", place=place["name"], holds=place["holds"]),
        "arguments": {"place": place["name"]},
    }


def _note(words: Words, place: Row) -> str:
    if place["by_people"]:
        return words("places.by_people")
    return words("places.of", device=place["device"]) if place["device"] else ""
