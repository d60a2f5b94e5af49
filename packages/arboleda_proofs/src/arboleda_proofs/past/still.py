"""Faces of the past: the offers of that time as text, as nothing of them can be done any more."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from arboleda.dashboard.faces import timeline
from arboleda.extension import Face, Moment

from .moments import address, dated, moment_of

Row = dict[str, Any]


def without_acts(face: Face) -> Face:
    """The same face without buttons; a button's label stands in its row if nothing else would."""
    found = {key: _without_acts(each) if key.startswith("row/") else each for key, each in face.items()}
    none: Face = {key: [] for key in found if key == "rows/for_all" or key.startswith("rows/ready.")}
    return found | none | {key: ["", ""] for key in found if key.endswith(".offer")}


def _without_acts(row: Row) -> Row:
    acts = row.get("acts", ())
    rest = {key: each for key, each in row.items() if key != "acts"}
    dots = [_dot(act) for act in acts if "state" in act]
    if dots:
        return rest | {"acts": dots}
    labels = " / ".join(act["label"] for act in acts)
    if not labels or (row["texts"] and row["texts"][0]):
        return rest
    return rest | {"texts": [labels, *row["texts"][1:]]}


def _dot(act: Row) -> Row:
    """The dot of a place, which shows how that stood."""
    return {key: act[key] for key in ("label", "name", "does", "state")} | {"refused": True}


def of_record(then: Moment, moment: int) -> Face:
    """The place in the record: the moment, the last event by then, and the browser's title."""
    event = then.events[-1] if then.events else None
    title, state = then.words("record.title", plant=then.snapshot["plant"]), "well"
    return {
        "past/at": moment,
        "text/record.at": [dated(moment), ""],
        "text/record.event": ["" if event is None else line(then, event), ""],
        "text/title": [title, state],
    }


def with_links(face: Face, events: Sequence[Row]) -> Face:
    """The rows of the time line, each leading to its moment."""
    keys = ((f"row/events/{each['number']}", each) for each in events)
    return {
        key: face[key] | {"link": {"column": 0, "to": {"at": address(moment_of(each["at"]))}}}
        for key, each in keys
        if key in face
    }


def line(then: Moment, event: Row) -> str:
    """The text of an event in one line."""
    _, cell, what, sentence = timeline.row(then, event)["texts"]
    return " · ".join(part for part in (cell, what, sentence) if part)
