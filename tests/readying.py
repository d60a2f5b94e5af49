"""Presser of *Make ready again*: answers yes to what it asks, once that is so, and lends no other hand."""

from __future__ import annotations

from typing import Any

from arboleda.model.advice import Hand
from arboleda.model.messages import Verb
from arboleda.rig import hands
from arboleda.testing import Rig
from arboleda.views import view
from arboleda.views.readying import Due, due_in_cell, due_in_plant

PATIENCE_S, LOOKS_S = 120.0, 0.5
HEARD_S = 1.0  # after work of a hand
TOLD = (Hand.TAKE_OUT, Hand.PUT_IN, Hand.LEAVE_IN)  # what is so once the plant is told
Row = dict[str, Any]


def due(rig: Rig, cell: str = "") -> Due | None:
    """What is due next in a cell, or in the whole plant."""
    snapshot = view.snapshot(rig.plant)
    if not cell:
        return due_in_plant(snapshot)
    return due_in_cell(snapshot, next(each for each in snapshot["cells"] if each["name"] == cell))


def make_ready(rig: Rig, cell: str = "") -> list[str]:
    """Press it; returns the acts in words. It ends as on the page: once nothing is due, at work of a hand, or
    where no act follows for so long."""
    acts: list[str] = []
    while _awaits_another(rig, cell, acts):
        next_one = due(rig, cell)
        if next_one is None or not next_one.is_act:
            break
        acts.append(give(rig, next_one))
    return acts


def give(rig: Rig, next_one: Due) -> str:
    """Give the act that is due, which is not refused; returns it in words."""
    advice = next_one.advice
    assert advice is not None
    for each in (each for each in next_one.before if Hand(each["do"]) not in TOLD):
        hands.HANDS[Hand(each["do"])](rig, each["scope"])
    if advice["by_hand"]:
        hands.BEFOREHAND[Verb(advice["do"])](rig.manual, advice["scope"])
        rig.wait(HEARD_S)
    arguments = dict(advice["arguments"])
    refusal = rig.operate(Verb(advice["do"]), advice["scope"], by_hand=advice["by_hand"], **arguments)
    assert refusal is None, f"{_words(next_one)} is due and refused: {refusal}"
    return _words(next_one)


def _awaits_another(rig: Rig, cell: str, acts: list[str]) -> bool:
    """Wait for an act that was not given yet, for work of a hand, or until nothing is due."""
    ends = rig.now + PATIENCE_S
    while rig.now < ends:
        found = due(rig, cell)
        if found is None or (found.advice is not None and _words(found) not in acts):
            return True
        rig.wait(LOOKS_S)
    return False


def _words(found: Due) -> str:
    advice = found.advice
    assert advice is not None
    told = " ".join(map(str, advice["arguments"].values()))
    words = " ".join(filter(None, (advice["do"], advice["scope"] or "plant", told)))
    return f"{words} --by-hand" if advice["by_hand"] else words
