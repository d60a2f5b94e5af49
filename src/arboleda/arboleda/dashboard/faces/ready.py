"""The button that makes a cell, or the whole plant, ready again: what is due next, and what it asks first."""

from __future__ import annotations

from typing import Any

from arboleda.model.messages import Verb
from arboleda.views.readying import Due, due_in_cell, due_in_plant

from . import Face, advice
from .moment import Moment

READY = "ready"
ACT, HAND, WAIT = "act", "hand", "wait"
Row = dict[str, Any]


def face(moment: Moment) -> Face:
    found: Face = {
        "list/stops": [act["number"] for act in moment.snapshot["acts"] if act["verb"] == Verb.STOP][-1:]
    }
    for cell in moment.snapshot["cells"]:
        due = due_in_cell(moment.snapshot, cell)
        found.update(_row(moment, f"{READY}.{cell['name']}", cell["name"], due))
    several = len(moment.snapshot["cells"]) > 1
    found.update(_row(moment, "for_all", "", due_in_plant(moment.snapshot) if several else None))
    return found


def _row(moment: Moment, name: str, of: str, due: Due | None) -> Face:
    """The list of one row, or none: the button, and the act that it does next as `due`."""
    if due is None:
        return {f"rows/{name}": []}
    words = moment.words
    kind = WAIT if due.advice is None else HAND if due.advice["hand"] else ACT
    button = {
        "act": READY,
        "of": of,
        "label": words(f"ready.{'cell' if of else 'plant'}"),
        "does": words("ready.does"),
        "refused": kind == HAND,
    }
    row = {"state": kind, "texts": [_says(moment, due)], "acts": [button], "due": _due(moment, kind, due)}
    return {f"rows/{name}": [READY], f"row/{name}/{READY}": row}


def _says(moment: Moment, due: Due) -> str:
    """The act that is due, or the reason to wait, in one line."""
    words = moment.words
    if due.advice is None:
        return words("ready.waits", why=words.say(due.why)) if due.why else words("ready.waits_still")
    said = advice.text(words, due.advice)
    if due.advice["hand"]:
        return words("ready.by_hand", said=said)
    return words("ready.next", said=said, note=advice.effect(words, due.advice))


def _due(moment: Moment, kind: str, due: Due) -> Row:
    """The act for the script: `says` is for people, the other keys are those of an offer."""
    told = {"kind": kind, "says": _says(moment, due)}
    if due.advice is None or due.advice["hand"]:
        return told
    words = moment.words
    offer = advice.offer(words, due.advice)
    before = [words("ready.done_by_hand", said=advice.text(words, each)) for each in due.before]
    return (
        told
        | {key: offer[key] for key in ("act", "of", "by_hand", "arguments") if key in offer}
        | {"asks": [*before, *offer["asks"]]}
    )
