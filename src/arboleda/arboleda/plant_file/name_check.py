"""Check of names: one name is one thing, on ROS 2, on MQTT and in the words of operators."""

from __future__ import annotations

from collections.abc import Callable

from .document import Document, Place, dotted, shown
from .shapes import NAME_RULE, ROBOT_KEYS, TAKER_KEY, is_name

RESERVED = ("plant", "system")  # first words of the plant's own ROS 2 topics


def check_names(document: Document, has_twin: Callable[[Place], bool]) -> None:
    """Keep a problem for each invalid cell name, each reserved word and each name used twice.

    A device that `has_twin` may be drawn under another name.
    """
    cells: list[Place] = [("cells", name) for name in document.keys(("cells",))]
    arms: list[Place] = [(*cell, TAKER_KEY) for cell in cells]
    robots: list[Place] = [(*cell, key) for cell in cells for key in ROBOT_KEYS]
    in_roles = [(*cell, "devices", role) for cell in cells for role in document.keys((*cell, "devices"))]
    devices = [place for place in in_roles if not document.has((*place, "shared"))]
    devices += [("shared", name) for name in document.keys(("shared",))]
    arms += [place for place in devices if has_twin(place)]
    own = _names(document, robots, "name") + _names(document, devices, "name")
    names = [(str(cell[-1]), cell) for cell in cells] + own
    for name, place in names:
        at = place if place in cells or place in devices else None
        if place in cells and not is_name(name):
            document.problem(place, f"a cell's name must be {NAME_RULE}", at=at)
        if name in RESERVED:
            document.problem(place, f"the name {shown(name)} is taken by topics of the plant itself", at=at)
    _differ(document, names + [(name, ("zones", name)) for name in document.keys(("zones",))], "name")
    _differ(document, _names(document, [*robots, *devices], "mqtt"), "MQTT name")
    _differ(document, _names(document, arms, "twin"), "twin name")
    _check_twins(document, arms, names)


def _names(document: Document, robots: list[Place], key: str) -> list[tuple[str, Place]]:
    """The name of each robot under `key`, else its `name`, else the role of a device."""
    rows = []
    for robot in robots:
        places = [(*robot, each) for each in (key, "name") if document.has((*robot, each))]
        if places and isinstance(name := document.value(places[0]), str):
            rows.append((name, places[0]))
        elif not places and _is_role(robot):
            rows.append((str(robot[-1]), robot))
    return rows


def _is_role(place: Place) -> bool:
    """True if a place is that of a device in a role, or of a shared device: its key may be its name."""
    return (len(place) == 4 and place[2] == "devices") or (len(place) == 2 and place[0] == "shared")


def _differ(document: Document, names: list[tuple[str, Place]], what: str) -> None:
    first: dict[str, Place] = {}
    for name, place in names:
        other = first.setdefault(name, place)
        by_default = what != "name" and not {place[-1], other[-1]} & {"mqtt", "twin"}
        if other != place and not by_default:
            named_by_role = _is_role(place)
            by_role = named_by_role and place[0] == "cells"
            own = f'; give it another, as in "name: {name}_{place[1]}"' if by_role else ""
            at = place if named_by_role else None
            document.problem(
                place, f"the {what} {shown(name)} is already that of {dotted(other)}{own}", at=at
            )


def _check_twins(document: Document, arms: list[Place], names: list[tuple[str, Place]]) -> None:
    owners = {name: place[:3] for name, place in names if len(place) > 2}
    for twin, place in _names(document, arms, "twin"):
        if owners.get(twin, place[:3]) != place[:3]:
            document.problem(place, f"the twin name {shown(twin)} is already that of {dotted(owners[twin])}")
