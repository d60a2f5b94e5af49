"""Smaller plant files: each says a little less than one that broke something, for shrinking."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from typing import Any

from .poses import Section

Place = tuple[str | int, ...]
CHIEF = frozenset({"cells", "arm", "mobile", "home", "pickup"})  # no cell is whole without them
NEEDED = CHIEF | {"name", "link", "evidence", "model", "deg", "mm"}


def smaller(file: Section) -> Iterator[Section]:
    """Files without one part each, the large parts first; zones name only what is left.

    Some of them may not be a plant file that `arboleda check` takes.
    """
    for place in sorted(_places(file), key=len):
        less = deepcopy(file)
        parent: Any = less
        for key in place[:-1]:
            parent = parent[key]
        del parent[place[-1]]
        _tidy(less)
        yield less


def _places(value: Any, place: Place = ()) -> Iterator[Place]:
    """The path of every key and position in it, the last one of a list first."""
    if isinstance(value, dict):
        keys: list[str | int] = [key for key in value if key not in NEEDED]
        inner: list[str | int] = list(value)
    elif isinstance(value, list) and place[-1] in ("poses", "moves"):
        keys = inner = [*reversed(range(len(value)))]
    else:
        return
    yield from ((*place, key) for key in keys)
    for key in inner:
        yield from _places(value[key], (*place, key))


def _tidy(file: Section) -> None:
    """Remove from zones what no longer exists, and zones that are empty."""
    zones = file.get("zones", {})
    for zone in zones.values():
        poses = [spot for spot in zone.get("poses", []) if _is_there(file, spot)]
        moves = [ends for ends in zone.get("moves", []) if all(_is_there(file, end) for end in ends)]
        zone.clear()
        zone |= {key: spots for key, spots in (("poses", poses), ("moves", moves)) if spots}
    for name in [name for name, zone in zones.items() if not zone]:
        del zones[name]
    if not zones:
        file.pop("zones", None)


def _is_there(file: Section, spot: str) -> bool:
    name, _, pose = spot.partition(" ")
    cell = file["cells"].get(name)
    if cell is None:
        return False
    stations = cell.get("stations", file.get("stations", {}))
    listed = "columns_q1_deg" not in stations
    return not (pose.startswith("station ") and listed and pose.removeprefix("station ") not in stations)
