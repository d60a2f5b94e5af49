"""Devices and cells of a plant file, made, changed and taken away: other values of the whole file.

What names a device goes away with it: targets, their groups, places and zones, what is needed of it, and its
kind if no other device has that. Recipes stay: the check says which of them miss it.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from copy import deepcopy
from typing import Any

from arboleda.drivers import among, quoted
from arboleda.plant_file.document import dotted
from arboleda.plant_file.yaml_edit import EditRefused
from arboleda_make.versions.change import CELLS, DEVICES, KINDS, TARGETS

Values = dict[str, Any]
HOME, GROUPS, PLACES, NEEDS, ZONES = "home", "groups", "places", "needs", "zones"
ODD = "{place} is written in a way that only people change; mend the plant file first"


def with_device(plant: Any, device: Mapping[str, Any], home: Mapping[str, Any] | None) -> Values:
    """The plant with a device, new or changed: `cell`, made with its first device, `role`, `kind`, the value
    of its `driver`, other `keys`, of which an empty one goes away, and the kind if it is `declared`.

    `home`: the pose of a robot at home, where it has none yet.
    """
    values: Values = deepcopy(plant)
    cell, role = device["cell"], device["role"]
    if device["declared"] is not None:
        _inside(values, KINDS)[device["kind"]] = device["declared"]
    devices = _inside(values, CELLS, cell, DEVICES)
    before = _part(devices, role)
    taken = {_name(*each) for at, each in _devices(values) if (at, each[0]) != (cell, role)}
    keys = {**before, "kind": device["kind"], **device["keys"], "driver": device["driver"]}
    if role in taken and not before.get("name"):
        keys["name"] = f"{cell}_{role}"
    if device["driver"]:
        keys["link"] = None  # the short form of a driver
    devices[role] = {key: each for key, each in keys.items() if each not in ("", None, {})}
    if home is not None:
        _inside(values, CELLS, cell, TARGETS, HOME).setdefault(role, dict(home))
    return values


def without_device(plant: Any, cell: str, role: str) -> Values:
    """The plant without a device; without its cell where it was the last one there."""
    values = deepcopy(plant)
    devices = _inside(values, CELLS, cell, DEVICES)
    if role not in devices:
        raise EditRefused(f"{quoted(role)} is no device of {cell}; {among(role, [*map(str, devices)])}")
    if len(devices) == 1:
        return without_cell(plant, cell)
    device = devices.pop(role)
    for other in _rows(devices):
        if other.get("tool_of") == role:
            del other["tool_of"]
    gone = _drop_of_cell(values[CELLS][cell], role)
    _drop_zones(values, {f"{cell} {each}" for each in gone}, {_name(role, device)})
    return _without_unused(values, [device])


def without_cell(plant: Any, cell: str) -> Values:
    """The plant without a cell."""
    values = deepcopy(plant)
    cells = _inside(values, CELLS)
    if cell not in cells:
        raise EditRefused(f"{quoted(cell)} is no cell of this plant; {among(cell, [*map(str, cells)])}")
    leaving = [each for at, each in _devices(values) if at == cell]
    targets = _part(_part(cells, cell), TARGETS)
    del cells[cell]
    _drop_zones(values, {f"{cell} {each}" for each in targets}, {_name(*each) for each in leaving})
    return _without_unused(values, [device for _, device in leaving])


def _inside(values: Any, *keys: str) -> Values:
    """The mapping at a place, made where there is none; EditRefused where something else stands there."""
    node: Any = values
    for number, key in enumerate(keys):
        if isinstance(node, dict) and node.get(key) is None:
            node[key] = {}
        node = node[key] if isinstance(node, dict) else None
        if not isinstance(node, dict):
            raise EditRefused(ODD.format(place=dotted(keys[: number + 1])))
    inside: Values = node
    return inside


def _part(values: Any, key: str) -> Values:
    """The mapping under a key; an empty one of its own where there is none."""
    part: Any = values.get(key) if isinstance(values, dict) else None
    return part if isinstance(part, dict) else {}


def _rows(values: Values) -> Iterator[Values]:
    return (each for each in values.values() if isinstance(each, dict))


def _devices(values: Values) -> Iterator[tuple[str, tuple[str, Any]]]:
    """The cell, and the role with the device, of each device."""
    for cell, row in _part(values, CELLS).items():
        for each in _part(row, DEVICES).items():
            yield cell, each


def _name(role: str, device: Any) -> str:
    """The name by which operators and zones know a device."""
    return str(_part({role: device}, role).get("name") or role)


def _drop_of_cell(cell: Values, role: str) -> set[str]:
    """Take what names a device out of its cell; the targets that no robot has any more."""
    for poses in _rows(_part(cell, TARGETS)):
        poses.pop(role, None)
    gone = {name for name, poses in _part(cell, TARGETS).items() if not poses}
    _retain(cell, TARGETS, lambda name, _: name not in gone)
    groups = _part(cell, GROUPS)
    for name, group in groups.items():
        groups[name] = [each for each in group if each not in gone] if isinstance(group, list) else group
    empty = {name for name, group in groups.items() if not group}
    _retain(cell, GROUPS, lambda name, _: name not in empty)
    _retain(
        cell,
        PLACES,
        lambda name, row: name not in gone | empty and not (isinstance(row, dict) and row.get("of") == role),
    )
    for needs in _rows(_part(cell, NEEDS)):
        for fact in [each for each in needs if str(each).startswith(f"{role}.")]:
            del needs[fact]
    _retain(cell, NEEDS, lambda name, needs: bool(needs) and not str(name).startswith(f"{role}."))
    return gone


def _drop_zones(values: Values, poses: Collection[str], devices: Collection[str]) -> None:
    """Take poses and devices that are gone out of the zones, and a zone that is left without any pose."""
    zones = _part(values, ZONES)
    for zone in _rows(zones):
        lists = {key: zone[key] for key in ("poses", "moves") if isinstance(zone.get(key), list)}
        for key, rows in lists.items():
            zone[key] = [each for each in rows if not _names_any(each, poses)]
            if rows and not zone[key]:
                del zone[key]
        _retain(zone, "free_while", lambda name, _: name not in devices)
    _retain(values, ZONES, lambda _, zone: not isinstance(zone, dict) or "poses" in zone or "moves" in zone)


def _names_any(row: Any, poses: Collection[str]) -> bool:
    """True for one of these poses, or a move from or to one."""
    return any(each in poses for each in (row if isinstance(row, list) else [row]))


def _without_unused(values: Values, leaving: Collection[Any]) -> Values:
    """The plant without the kinds of devices that leave it, unless others have them."""
    kinds = {_part({"": each}, "").get("kind") for each in leaving}
    others = [*(device for _, (_, device) in _devices(values)), *_rows(_part(values, "shared"))]
    used = {_part({"": each}, "").get("kind") for each in others}
    _retain(values, KINDS, lambda name, _: name in used or name not in kinds)
    return values


def _retain(values: Values, key: str, stays: Callable[[Any, Any], bool]) -> None:
    """Keep some entries of a mapping, and the mapping itself only with an entry."""
    before = values.get(key)
    if isinstance(before, dict):
        values[key] = {name: each for name, each in before.items() if stays(name, each)}
        if before and not values[key]:
            del values[key]
