"""Changes of a plant's files that a running plant cannot take, each with the reason."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from arboleda.plant_file.recipe_forms import XML

from .change import MISSING, Change

CELLS, TIMING, USES = "cells", "timing", "uses"
OF_PLANT = ("history_days", "paths", "stations", "palletizing")
OF_CELL = (
    "recipes",
    "default_recipe",
    "queue_limit",
    "on_restart",
    "on_absence",
    "retry",
    "targets",
    "groups",
    "paths",
    "drive_to_start",
    "piece_check",
    "zone_wait_s",
    "teach",
    "handover",
    "home",
    "pickup",
    "pickups",
    "stations",
    "palletizing",
)
SILENCE = "stale_after_s"
WHY = {
    "zones": "who is in a zone is not counted anew while the plant runs",
    "places": "which parts lie where is not counted anew while the plant runs",
    "needs": "what a device needs is checked from the start of the plant on",
    "kinds": "what a device can do is agreed with it when the plant starts",
    "shared": "a device joins its cells when the plant starts",
    "devices": "a device and its driver are reached from the start of the plant on",
    "extensions": "a package gets its settings when the plant starts",
    "store": "the memory is opened when the plant starts",
    SILENCE: "the bridge and the drivers watch their links by it, too",
}
OF_START = "the plant reads it when it starts"
PYTHON = "Python is not imported again into a process that runs: what it has made there would stay the old"
CELL = "a cell joins the plant, or leaves it, when the plant starts"


def needing_restart(changes: Iterable[Change]) -> tuple[str, ...]:
    """A line for each change that needs a restart of the plant, or a handover, with the reason."""
    rows = ((each, _reason(each)) for each in changes)
    return tuple(f"{each.words}: {why}" for each, why in rows if why)


def _reason(change: Change) -> str:
    """The reason why a running plant cannot take a change; "" where the plant can."""
    place = [str(key) for key in change.place]
    if not place:
        return "" if change.file.endswith(XML) else _of_file(change)
    if place[0] == CELLS:
        return _of_cell(change, place[1:])
    if place[0] == TIMING:
        return WHY[SILENCE] if _touches(change, place[1:], SILENCE) else ""
    if place[0] == USES:
        return PYTHON if _python(change.before) != _python(change.after) else ""
    return "" if place[0] in OF_PLANT else WHY.get(place[0], OF_START)


def _of_file(change: Change) -> str:
    return PYTHON if change.file.endswith(".py") else WHY["devices"]


def _of_cell(change: Change, place: list[str]) -> str:
    if len(place) < 2:
        return CELL
    return "" if place[1] in OF_CELL else WHY.get(place[1], WHY["devices"])


def _touches(change: Change, place: list[str], key: str) -> bool:
    """True for a change of this key, or of its whole mapping with another value of the key."""
    if place:
        return place[0] == key
    values = [each.get(key) if isinstance(each, dict) else None for each in (change.before, change.after)]
    return values[0] != values[1]


def _python(value: Any) -> list[object]:
    """Entries of `uses` that are no trees."""
    words = value if value is not MISSING and isinstance(value, list) else []
    return [each for each in words if not str(each).endswith(XML)]
