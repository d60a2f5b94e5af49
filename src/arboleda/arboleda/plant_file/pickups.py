"""Poses at which an arm takes parts from its mobile robot: one for all exits, one for each, or both."""

from __future__ import annotations

from collections.abc import Sequence

from arboleda.model.plant_model import Path, Pose

from .document import Document, Place, choice
from .paths import exit_of
from .poses import PICKUP, PICKUP_AT, PoseReader
from .shapes import MAPPING

Pickups = tuple[tuple[str, Pose], ...]  # by exit


def default_pickup(reader: PoseReader, cell: Place) -> Pose | None:
    """The pick-up for all exits that have no pick-up of their own."""
    return reader.pose((*cell, "pickup"), PICKUP())


def pickups(reader: PoseReader, cell: Place, paths: Sequence[Path]) -> Pickups | None:
    """The pick-ups of single exits; None, with the problems kept, if one is wrong or missing."""
    document, place = reader.document, (*cell, "pickups")
    if document.has(place):
        document.read_plain(MAPPING, place)
    elif not document.has((*cell, "pickup")):
        document.problem(cell, 'the key "pickup" is missing')
    exits = sorted({exit_of(path) for path in paths})
    first_pickups: dict[str, str] = {}
    rows = []
    for key in document.keys(place):
        first = first_pickups.setdefault(key.upper(), key)
        if first != key:
            twice = f'is the same exit as "{first}", case does not matter'
            document.problem((*place, key), twice, at=(*place, key))
        elif exits and key.upper() not in exits:
            rule = f"is no exit of a path here, the second character of its code; there is {choice(exits)}"
            document.problem((*place, key), rule, at=(*place, key))
        rows.append((key.upper(), reader.pose((*place, key), PICKUP_AT(exit=key.upper()))))
    _check_every_exit(document, cell, exits, first_pickups)
    whole = tuple((exit, pose) for exit, pose in rows if pose)
    return whole if len(whole) == len(rows) else None


def pickup_names(pickup: Pose, each: Pickups) -> dict[str, Pose]:
    """Pick-ups by the names that they have in a plant file: `pickup`, `pickup A`."""
    return {"pickup": pickup} | {f"pickup {exit.lower()}": pose for exit, pose in each}


def _check_every_exit(document: Document, cell: Place, exits: Sequence[str], pickups: dict[str, str]) -> None:
    without_pickup = [exit for exit in exits if exit not in pickups]
    if without_pickup and pickups and not document.has((*cell, "pickup")):
        rule = 'add it, or a "pickup" for all exits that are not named here'
        exit = choice(without_pickup)
        document.problem((*cell, "pickups"), f"the exit {exit} of the paths has no pick-up; {rule}")
