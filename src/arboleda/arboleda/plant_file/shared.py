"""Devices that cells share: declared once at the top of the plant file, and named by each cell in a role."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from arboleda.model.plant_model import Robot

from .document import Document, Place, choice, nearest, shown
from .shapes import MAPPING, NAME_RULE, SharedRoleShape, is_name

SECTION = "shared"  # key of the file; in a role of a cell, the key for the device's name
OF_A_CELL = ("name", "tool_of")
Read = Callable[[Place], "Robot | None"]


def shared_devices(document: Document, read: Read, goes: Callable[[Place], bool]) -> dict[str, Robot]:
    """The devices by name, as `read` reads one; the problems of the others are kept.

    A robot that `goes` from place to place is a problem, too.
    """
    if not document.has((SECTION,)):
        return {}
    document.read_plain(MAPPING, (SECTION,))
    found = {}
    for name in document.keys((SECTION,)):
        place: Place = (SECTION, name)
        if not is_name(name):
            document.problem(place, f"a shared device must be {NAME_RULE}", at=place)
        device = None if _refused(document, place, goes(place)) else read(place)
        if device is None:
            continue
        if device.held_fact is not None:
            rule = "a shared device holds no part: no other cell would know whose that is"
            document.problem((*place, "kind"), f"{rule}; give each cell its own")
        found[name] = device
    return found


def in_role(document: Document, place: Place, devices: Mapping[str, Robot]) -> Robot | None:
    """The shared device in a role of a cell; None, with the problem kept, if there is no such one."""
    shape = document.read(SharedRoleShape, place)
    names = document.keys((SECTION,))
    if shape is None:
        return None
    if shape.shared not in names:
        there = f"must be {choice(names)}" if names else f'there is no "{SECTION}" at the top of the file'
        hint = nearest(shape.shared, names)
        document.problem((*place, SECTION), f"{there}, is {shown(shape.shared)}{hint}")
    return devices.get(shape.shared)


def named(document: Document, cell: Place) -> dict[str, str]:
    """The shared devices that a cell names, by role."""
    roles = [(*cell, "devices", role) for role in document.keys((*cell, "devices"))]
    found = {str(place[-1]): document.value((*place, SECTION)) for place in roles}
    return {role: name for role, name in found.items() if isinstance(name, str)}


def check_use(document: Document) -> None:
    """Keep a problem for each shared device that no cell names, and for cells that name it wrongly."""
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
    for name in document.keys((SECTION,)):
        if name not in used:
            place = (SECTION, name)
            how = f"{{shared: {name}}}"
            document.problem(
                place, f"no cell has it; name it in a role of each that uses it, {how}", at=place
            )


def _refused(document: Document, place: Place, goes: bool) -> bool:
    """True if a shared device has something that only devices of one cell can have; each is a problem."""
    if goes:
        rule = "a robot that goes from place to place belongs to one cell; what is shared stays where it is"
        document.problem((*place, "kind"), rule)
        return True
    own = [key for key in OF_A_CELL if document.has((*place, key))]
    for key in own:
        why = "its key is its name" if key == "name" else "it would go with a robot of one cell"
        document.problem((*place, key), f"a shared device has no {key}: {why}", at=(*place, key))
    return bool(own)
