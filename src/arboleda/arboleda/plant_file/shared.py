"""Devices that cells share: declared once at the top of the plant file, and named by each cell in a role."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from arboleda.model.plant_model import Cell, Evidence, Link, Pose, Robot

from .document import Document, Place, misnamed
from .shapes import MAPPING, NAME_RULE, SharedRoleShape, is_name

SECTION = "shared"  # key of the file; in a role of a cell, the key for the device's name
TOOL_OF = "tool_of"
Read = Callable[[Place], "Robot | None"]


def shared_devices(document: Document, read: Read) -> dict[str, Robot]:
    """The correct shared devices by name; `read` reads one. Problems of the others are kept."""
    if not document.has((SECTION,)):
        return {}
    document.read_plain(MAPPING, (SECTION,))
    devices = {}
    for name in document.keys((SECTION,)):
        place: Place = (SECTION, name)
        if not is_name(name):
            document.problem(place, f"a shared device must be {NAME_RULE}", at=place)
        if document.has((*place, "name")):
            why = "a shared device has no name: its key is its name"
            document.problem((*place, "name"), why, at=(*place, "name"))
            continue
        device = read(place)
        if device is not None and _shows_its_place(document, place, device):
            devices[name] = device
    for name, device in devices.items():
        _check_tool(document, (SECTION, name), device, devices)
    return devices


def tools(document: Document) -> dict[str, str]:
    """The names of the tools that shared robots carry, by the names of the robots."""
    names, by_robot = document.keys((SECTION,)), dict[str, str]()
    for name in names:
        robot = document.value((SECTION, name, TOOL_OF))
        if robot in names:
            by_robot.setdefault(str(robot), name)
    return by_robot


def in_role(document: Document, place: Place, devices: Mapping[str, Robot]) -> Robot | None:
    """The shared device in a role of a cell; None, with the problem kept, where there is none."""
    shape = document.read(SharedRoleShape, place)
    names = document.keys((SECTION,))
    if shape is None:
        return None
    if shape.shared not in names:
        none = f'there is no "{SECTION}" at the top of the file'
        document.problem((*place, SECTION), misnamed(shape.shared, names, none))
    return devices.get(shape.shared)


def named(document: Document, cell: Place) -> dict[str, str]:
    """The shared devices that a cell names, by role."""
    roles = [(*cell, "devices", role) for role in document.keys((*cell, "devices"))]
    by_role = {str(place[-1]): document.value((*place, SECTION)) for place in roles}
    return {role: name for role, name in by_role.items() if isinstance(name, str)}


def check_use(document: Document) -> None:
    """Keep a problem for each shared device that no cell names, or that a cell names wrongly."""
    used = set()
    for cell in document.keys(("cells",)):
        place: Place = ("cells", cell)
        names = named(document, place)
        used |= set(names.values())
        twice = [role for role, name in names.items() if name in list(names.values())[: [*names].index(role)]]
        for role in twice:
            at = (*place, "devices", role)
            document.problem(at, f"{names[role]} is in this cell already, in another role", at=at)
        if names and len(names) == len(document.keys((*place, "devices"))):
            rule = "all its devices are shared; a cell has at least one of its own"
            document.problem((*place, "devices"), rule, at=(*place, "devices"))
        _check_use_in(document, place)
    for name in document.keys((SECTION,)):
        if name not in used:
            place = (SECTION, name)
            how = f"{{shared: {name}}}"
            document.problem(
                place, f"no cell has it; name it in a role of each that uses it, {how}", at=place
            )


def check_homes(document: Document, cells: Sequence[Cell]) -> None:
    """Keep a problem for each cell in which a shared robot has another home than in its first cell."""
    first: dict[str, tuple[str, Pose]] = {}
    for cell in cells:
        roles = {robot.name: role for role, robot in cell.roles.items()}
        for name in cell.shared_movers:
            home = cell.reach[name].home
            other, at = first.setdefault(name, (cell.name, home))
            if (home.q, home.above) != (at.q, at.above):
                place: Place = ("cells", cell.name, "targets", home.name, roles[name])
                rule = f"{name} has another {home.name} in {other}"
                why = "what one cell leaves is where the next one begins, so make them equal"
                document.problem(place, f"{rule}; {why}", at=place)


def _check_use_in(document: Document, cell: Place) -> None:
    """Keep a problem for a shared robot without its tool in a cell, and for one with paths or handovers."""
    names = named(document, cell)
    for robot, tool in tools(document).items():
        for one, other in ((robot, tool), (tool, robot)):
            if one in names.values() and other not in names.values():
                role = next(role for role, name in names.items() if name == one)
                at = (*cell, "devices", role)
                pair = f"{robot} carries {tool}" if one == robot else f"{tool} goes with {robot}"
                how = f"name {other} in a role, too, {{shared: {other}}}"
                document.problem(at, f"{pair}, so a cell has both; {how}", at=at)
    for role, name in names.items():
        if document.has((*cell, "paths", role)):
            rule = f"{name} is shared, and no cell knows the ways of another one's paths; give it targets"
            document.problem((*cell, "paths", role), rule, at=(*cell, "paths", role))
    for key in ("taker", "giver"):
        place = (*cell, "handover", key)
        if document.has(place) and document.value(place) in names:
            rule = f"{names[document.value(place)]} is shared; a handover is between two robots of one cell"
            document.problem(place, rule)


def _shows_its_place(document: Document, place: Place, device: Robot) -> bool:
    """False, with the problem kept, for a robot that cannot report where it is to its next cell."""
    if not device.goes:
        return True
    if device.link is Link.NONE:
        document.problem((*place, "link"), "is only drawn; cells share what can be told something")
    elif device.evidence is Evidence.STATE:
        why = "a shared robot has to say that it is at home before another cell has it"
        document.problem((*place, "evidence"), f"must be ids or joints: {why}")
    else:
        return True
    return False


def _check_tool(document: Document, place: Place, device: Robot, devices: Mapping[str, Robot]) -> None:
    here = (*place, TOOL_OF)
    if not document.has(here):
        return
    carrier, robots = document.value(here), [name for name, each in devices.items() if each.goes]
    if carrier in document.keys((SECTION,)) and carrier not in devices:
        return  # its problems are reported at the carrier
    if carrier not in robots:
        document.problem(here, misnamed(carrier, robots, "no shared device is a robot"))
    elif device.held_fact is None:
        document.problem(here, f"{device.name} holds no part: none of its verbs has holds: part")
    elif (first := tools(document)[str(carrier)]) != device.name:
        document.problem(here, f"{carrier} carries {first} already")
