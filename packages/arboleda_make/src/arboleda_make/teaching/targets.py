"""Targets of a cell in the plant file: those that there are, and the values that make one or move it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from arboleda.drivers import Robot
from arboleda.model.plant_model import Cell
from arboleda_make.teaching.api import Spot, Target, TeachRefused

from . import devices as taught_devices

Row = dict[str, Any]
Place = tuple[str | int, ...]
Values = Mapping[str, Any] | None
HOME, OF_STORAGE = "home", ("home", "pickup")
OF_ARRAY = "{target} is one of an array, which the plant file makes of its corners; change those there"
OF_RACK = "in {cell} the arm is taught at home, pickup and pickup_EXIT; the file has what else it reaches"
BAD_NAME = "a target is called by a letter, then letters, digits and _, at most 60 of them"
NO_ZONE = "there is no zone {zone}; there are {known}"
NO_APPROACH = "{robot} has no joint that slides up and down, and so no approach height"
TOO_HIGH = "{robot} can go up {room:g} mm from here, so an approach of {approach:g} mm cannot be"
MOST_LETTERS = 60


def targets(cell: Cell, values: Values) -> list[Row]:
    """The targets of each robot of a cell: those that run, and those of the draft where they are others."""
    roles = {robot.name: role for role, robot in cell.members}
    found = {
        (name, space.robot.name): taught_devices.spot(space.robot, pose.q)
        for space in cell.spaces
        for name, pose in space.targets.items()
    }
    rows = [{"name": name, "robot": robot, "at": at, "draft": False} for (name, robot), at in found.items()]
    drafted = {
        (name, space.robot.name): at
        for space in cell.spaces
        for name, at in _drafted(cell, values, roles[space.robot.name], space.robot)
    }
    others = {key: at for key, at in drafted.items() if key not in found or not _is_same(at, found[key])}
    rows = [each for each in rows if (each["name"], each["robot"]) not in others]
    return [
        *rows,
        *({"name": name, "robot": robot, "at": at, "draft": True} for (name, robot), at in others.items()),
    ]


def edits(cell: Cell, values: Values, robot: Robot, target: Target, at: Spot) -> list[tuple[Place, Any]]:
    """The values to set in the plant file for a target that is where a robot stands."""
    if not target.target.isidentifier() or not target.target.isascii() or len(target.target) > MOST_LETTERS:
        raise TeachRefused(BAD_NAME)
    place = _place(cell, values, robot, target.target)
    known = _at(values, place)
    spot = _written(robot, at)
    approach = target.approach_mm
    if approach is None and isinstance(known, Mapping):
        approach = known.get("approach_mm")
    if approach:
        _check_room(robot, at, approach)
        spot["approach_mm"] = approach
    found = list(_grown(values, place, spot))
    return found + ([_in_zone(cell, values, target)] if target.zone else [])


def _check_room(robot: Robot, at: Spot, approach: float) -> None:
    """Raise TeachRefused where a robot that stands there cannot be so much, in mm, above it."""
    lifting = [number for number, joint in enumerate(robot.joints) if joint.unit != "rad" and joint.up]
    if isinstance(at, int) or not lifting:
        raise TeachRefused(NO_APPROACH.format(robot=robot.name))
    joint, here = robot.joints[lifting[-1]], at[lifting[-1]]
    room = joint.upper * 1000 - here if joint.up > 0 else here - joint.lower * 1000
    if approach > room + 10**-taught_devices.DIGITS:
        raise TeachRefused(TOO_HIGH.format(robot=robot.name, room=round(max(room, 0), 1), approach=approach))


def _grown(values: Values, place: Place, value: Any) -> Iterator[tuple[Place, Any]]:
    """The value at its place, in what of the way to it is missing in the file."""
    for length in range(1, len(place)):
        if _at(values, place[:length]) is None:
            for key in reversed(place[length:]):
                value = {key: value}
            yield place[:length], value
            return
    yield place, value


def _in_zone(cell: Cell, values: Values, target: Target) -> tuple[Place, Any]:
    zones = _at(values, ("zones",)) or {}
    if target.zone not in zones:
        raise TeachRefused(NO_ZONE.format(zone=target.zone, known=", ".join(zones) or "none"))
    poses = list(_at(values, ("zones", target.zone, "poses")) or [])
    name = f"{cell.name} {target.target}"
    return ("zones", target.zone, "poses"), poses if name in poses else [*poses, name]


def _place(cell: Cell, values: Values, robot: Robot, target: str) -> Place:
    here: Place = ("cells", cell.name)
    if _at(values, (*here, "devices")) is not None:
        made = [name for group, *_ in cell.grids for name in cell.groups.get(group, ())]
        if target in made:
            raise TeachRefused(OF_ARRAY.format(target=target))
        role = next(role for role, each in cell.members if each.name == robot.name)
        return (*here, "targets", target, role)
    if target in OF_STORAGE and robot.joints:
        return (*here, target)
    exits = cell.paths.keys()
    code = target.removeprefix("pickup_")
    if robot.joints and target.startswith("pickup_") and any(each.endswith(code) for each in exits):
        return (*here, "pickups", code)
    raise TeachRefused(OF_RACK.format(cell=cell.name))


def _at(values: Values, place: Place) -> Any:
    """The value at a place of the file; None where there is none."""
    found: Any = values
    for key in place:
        if not isinstance(found, Mapping) or key not in found:
            return None
        found = found[key]
    return found


def _written(robot: Robot, at: Spot) -> Row:
    """A position as plant files have it."""
    if isinstance(at, int):
        return {"node": at}
    rows = list(zip(robot.joints, at, strict=True))
    turned = [value for joint, value in rows if joint.unit == "rad"]
    slid = [value for joint, value in rows if joint.unit != "rad"]
    return {
        **({"deg": turned} if turned else {}),
        **({"mm": slid[0] if len(slid) == 1 else slid} if slid else {}),
    }


def _drafted(cell: Cell, values: Values, role: str, robot: Robot) -> Iterator[tuple[str, Spot]]:
    """The targets that the draft's plant file has for a robot, in the form of devices."""
    for name, roles in (_at(values, ("cells", cell.name, "targets")) or {}).items():
        at = _read(robot, roles.get(role)) if isinstance(roles, Mapping) else None
        if at is not None:
            yield str(name), at
    if _at(values, ("cells", cell.name, "devices")) is None and robot.joints:
        for name in OF_STORAGE:
            if (at := _read(robot, _at(values, ("cells", cell.name, name)))) is not None:
                yield name, at


def _read(robot: Robot, written: Any) -> Spot | None:
    """A position out of a plant file that nobody has checked yet; None where it is none."""
    if not isinstance(written, Mapping):
        return None
    if robot.floor_grid is not None:
        node = written.get("node")
        return node if isinstance(node, int) else None
    turned, slid = _numbers(written.get("deg")), _numbers(written.get("mm"))
    wanted = [joint.unit for joint in robot.joints]
    if (len(turned), len(slid)) != (wanted.count("rad"), len(wanted) - wanted.count("rad")):
        return None
    return [turned.pop(0) if unit == "rad" else slid.pop(0) for unit in wanted]


def _numbers(written: Any) -> list[float]:
    listed = written if isinstance(written, Sequence) and not isinstance(written, str) else [written]
    return [float(each) for each in listed if isinstance(each, int | float) and not isinstance(each, bool)]


def _is_same(one: Spot, other: Spot) -> bool:
    if isinstance(one, int) or isinstance(other, int):
        return one == other
    apart = [abs(a - b) for a, b in zip(one, other, strict=False)]
    return len(one) == len(other) and max(apart, default=0.0) < 10**-taught_devices.DIGITS
