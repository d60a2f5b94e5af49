"""Cells that are made of devices by role: robots, and devices of declared kinds or of kinds in Python."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from arboleda.kinds import WrittenKind
from arboleda.kinds.declared import Device, DeviceKind
from arboleda.kinds.rules import LEAST_S
from arboleda.model.plant_model import Cell, Evidence, Link, Robot

from . import handovers, needs, own_kinds, part_places, shared, targets
from .any_cell import check_absence, common_keys
from .arrays import arrays
from .deadlines import is_proven
from .document import Document, Place, choice, misnamed, nearest, shown
from .drivers import OF_DEVICES, link
from .not_installed import why_nobody
from .python_uses import KindInPython, PythonUses
from .robot_kind import RobotKind
from .shapes import NAME_RULE, ROBOT_KEYS, DeviceCellShape, DeviceShape, is_name
from .shipped_kinds import COME_WITH_IT, RESERVED

CELLS: Place = ("cells",)
EVIDENCE = {"facts": Evidence.JOINTS}  # a device reports its facts as an arm reports its joints


@dataclass(frozen=True, kw_only=True)
class Kinds:
    """The kinds of a plant's devices: those that its file declares, and those in Python."""

    declared: Mapping[str, DeviceKind]
    names: Collection[str]  # of all kinds that the file declares, right or wrong
    used: PythonUses

    def in_python(self, name: object) -> KindInPython | None:
        """The kind in Python of that name, unless the plant file declares one of the same name."""
        if not isinstance(name, str) or (name in self.names and name not in RESERVED):
            return None
        return self.used.kinds.get(name)

    def goes(self, document: Document, place: Place) -> bool:
        """True if the device there is a robot that goes from place to place."""
        kind = self.of_robots(document, place)
        return kind is not None and kind.goes

    def has_twin(self, document: Document, place: Place) -> bool:
        """True if the device there may be drawn under another name."""
        kind = self.of_robots(document, place)
        return kind is not None and kind.has_twin

    def of_robots(self, document: Document, place: Place) -> RobotKind | None:
        """The kind of the device there, if it reads the device's keys by itself."""
        kind = self.in_python(document.value((*place, "kind")))
        return kind if isinstance(kind, RobotKind) else None

    @property
    def all_names(self) -> list[str]:
        """The names of all kinds."""
        used = self.used
        return list(dict.fromkeys([*self.names, *used.kinds, *COME_WITH_IT, *used.installed]))


def is_of_devices(document: Document, place: Place) -> bool:
    """True if a cell is one of devices, going by its keys."""
    has = set(document.keys(place))
    return "devices" in has or (document.has(("kinds",)) and not has.intersection(ROBOT_KEYS))


def shared_devices(document: Document, kinds: Kinds) -> dict[str, Robot]:
    """The devices that cells share, by name."""

    def read(place: Place) -> Robot | None:
        return _device(document, place, kinds)

    devices = shared.shared_devices(document, read)
    shared.check_use(document)
    return devices


def device_cell(document: Document, place: Place, kinds: Kinds, common: Mapping[str, Robot]) -> Cell | None:
    """The cell, still without recipes; None, with its problems kept, if something is wrong with it.

    `common` are the devices that cells share, by name.
    """
    both = [key for key in ROBOT_KEYS if document.has((*place, key))]
    for key in both:
        rule = 'a cell has either "arm" and "mobile" or "devices"'
        what = f'{rule}; as one of its devices, it is "{key}: {{kind: {key}, ...}}"'
        document.problem((*place, key), what, at=(*place, key))
    shape = None if both else document.read(DeviceCellShape, place)
    keys = common_keys(document, place, shape)
    names = document.keys((*place, "devices"))
    sharing = shared.named(document, place)
    devices = {
        role: shared.in_role(document, (*place, "devices", role), common)
        if role in sharing
        else _device(document, (*place, "devices", role), kinds)
        for role in names
    }
    members = {role: device for role, device in devices.items() if device is not None}
    tools = _tools(document, (*place, "devices"), members, sharing)
    if shape is None or keys is None or len(members) < len(devices):
        return None
    spaces = targets.workspaces(document, place, members, tools)
    if spaces is None or (spaces := handovers.with_paths(document, place, members, spaces)) is None:
        return None
    check_absence(document, place, shape.on_absence, members.values())
    groups = targets.groups(document, place, spaces)
    handover = handovers.handover(document, place, members, spaces)
    return Cell(
        **keys,
        members=tuple(members.items()),
        spaces=spaces,
        handover=handover,
        recipes=handovers.recipes(document, place, handover, members, dict(groups)),
        needs=needs.needs(document, place, members),
        places=part_places.places(document, place, members, spaces, dict(groups)),
        arrays=groups,
        grids=tuple((each.group, each.rows, each.columns) for each in arrays(document, place)),
        shared=tuple(sharing.values()),
    )


def _tools(
    document: Document, place: Place, members: Mapping[str, Robot], sharing: Mapping[str, str]
) -> dict[str, Robot]:
    """The devices that robots carry, by the role of the robot; `sharing` has the shared ones by role."""
    roles, carried = {name: role for role, name in sharing.items()}, shared.tools(document)
    tools: dict[str, Robot] = {
        role: members[roles[carried[name]]]
        for role, name in sharing.items()
        if role in members and roles.get(carried.get(name, "")) in members
    }
    robots = [role for role, device in members.items() if device.goes]
    for role, device in members.items():
        here = (*place, role, "tool_of")
        own = role not in robots and role not in sharing
        carrier = document.value(here) if own and document.has(here) else None
        if carrier is None:
            continue
        if carrier in sharing:
            how = f'declare it under "shared", with tool_of: {sharing[carrier]}'
            document.problem(here, f"{carrier} is shared, and so is what it carries; {how}")
            continue
        if carrier in document.keys(place) and carrier not in members:
            continue  # the problems of that device are reported at the device
        if carrier not in robots:
            document.problem(here, misnamed(carrier, robots, "no device of this cell is a robot"))
        elif device.held_fact is None:
            document.problem(here, f"{role} holds no part: none of its verbs has holds: part")
        elif carrier in tools:
            document.problem(here, f"{carrier} carries {tools[carrier].name} already")
        else:
            tools[carrier] = device
    return tools


def _device(document: Document, place: Place, kinds: Kinds) -> Robot | None:
    role, kind = str(place[-1]), kinds.of_robots(document, place)
    if not is_name(role):
        document.problem(place, f"a role must be {NAME_RULE}", at=place)
        return None
    if kind is None:
        return _machine(document, place, kinds)
    return own_kinds.robot(document, place, kind, kinds.used)


def _machine(document: Document, place: Place, kinds: Kinds) -> Device | None:
    written = kinds.in_python(document.value((*place, "kind")))
    if isinstance(written, WrittenKind):
        described = own_kinds.device(document, place, written, kinds.used)
        shape, kind = described or (None, None)
    else:
        kind = _kind(document, (*place, "kind"), kinds)
        name = document.value((*place, "kind"))
        is_unknown = (
            isinstance(name, str) and name not in kinds.names
        )  # its keys may be those of a kind in Python
        shape = None if is_unknown else document.read(DeviceShape, place)
    if shape is None or kind is None:
        return None
    evidence = EVIDENCE.get(shape.evidence) or Evidence(shape.evidence)
    name = shape.name or str(place[-1])
    way = link(document, place, shape.link, OF_DEVICES)
    if not kind.verbs and way is not Link.DRIVER:
        here = (*place, "kind")
        document.problem(here, f"{kind.name} has no verbs; only a device with a driver may have none")
        return None
    if way is not Link.DRIVER:  # else it is checked with its driver, whose settings may give the evidence
        proven = [is_proven(document, place, kind.name, verb, evidence) for verb in kind.verbs.values()]
        if not all(proven):
            return None
    return Device(
        name=name,
        mqtt=shape.mqtt or name,
        link=way,
        evidence=evidence,
        timeout_s=max((verb.at_most_s for verb in kind.verbs.values()), default=LEAST_S),
        has_stop=shape.stop == "supported",
        kind=kind,
    )


def _kind(document: Document, place: Place, kinds: Kinds) -> DeviceKind | None:
    """The declared kind of that name; None, with the problem kept, if there is none or it is wrong."""
    name = document.value(place)
    if not isinstance(name, str) or name in kinds.names:
        return kinds.declared.get(name) if isinstance(name, str) else None
    hint = nearest(name, kinds.all_names)
    if name in kinds.used.broken or not kinds.used.may_import:
        return None
    if why := why_nobody(document, own_kinds.GROUP, name):
        document.problem(place, why)
    elif hint or kinds.used.is_whole:  # else a file that could not be imported may have the kind
        own = "" if hint else '; one of your own is declared under "kinds" at the top of the file'
        document.problem(place, f"must be {choice(kinds.all_names)}, is {shown(name)}{hint or own}")
    return None
