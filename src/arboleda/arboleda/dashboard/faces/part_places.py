"""Places of a cell as dots, those of a rack in one row: full or empty, and what a person may say of each."""

from __future__ import annotations

import re
from typing import Any

from arboleda.model.messages import Verb

from ..wording import Words
from . import Face
from .moment import Moment

Row = dict[str, Any]
NUMBERED = re.compile(r"(.+?)_?([0-9]+)", re.ASCII)


def face(moment: Moment) -> Face:
    found: Face = {}
    for cell in moment.snapshot["cells"]:
        if cell["places"]:
            found.update(_of(moment.words, cell))
    return found


def _of(words: Words, cell: Row) -> Face:
    name, racks = cell["name"], dict[str, list[Row]]()
    for place in cell["places"]:
        racks.setdefault(_rack(place["name"])[0], []).append(place)
    found: Face = {f"rows/places.{name}": list(racks)}
    for rack, places in racks.items():
        found[f"row/places.{name}/{rack}"] = {
            "state": "",
            "texts": [rack, " · ".join(dict.fromkeys(filter(None, (_note(words, each) for each in places))))],
            "acts": [_dot(words, name, each) for each in places],
        }
    return found


def _rack(place: str) -> tuple[str, str]:
    """The rack of a place and its number there; the number of a place that stands alone is ""."""
    numbered = NUMBERED.fullmatch(place)
    return (place, "") if numbered is None else (numbered[1], numbered[2])


def _dot(words: Words, cell: str, place: Row) -> Row:
    """The button of a place: a person says by it that the parts were taken out, or put in where none is."""
    name, parts, holds = place["name"], place["parts"], place["holds"]
    verb = Verb.UNLOAD if parts else Verb.LOAD
    return {
        "act": verb.value,
        "of": cell,
        "label": f"{parts}/{holds}" if holds > 1 else _rack(name)[1],
        "name": f"{name}: {words('places.parts', parts=parts, holds=holds)}. {words.of('verb', verb.value)}",
        "does": words(f"places.{verb.value}", place=name, holds=holds),
        "arguments": {"place": name},
        "state": "taken" if parts else "free",
        "refused": place["by_people"] and not _is_asked(place),
    }


def _note(words: Words, place: Row) -> str:
    if _is_asked(place):
        return words("places.asked", place=place["name"])
    if place["by_people"]:
        return words("places.by_people")
    return words("places.of", device=place["device"]) if place["device"] else ""


def _is_asked(place: Row) -> bool:
    return bool(place.get("asked"))  # older records have none
