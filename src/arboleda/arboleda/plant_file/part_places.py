"""Places of a cell of devices: the targets at which parts lie, and how many each of them holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from arboleda.model.plant_model import Place as PartPlace
from arboleda.model.plant_model import Robot, Workspace

from .document import Document, Place, choice, nearest, shown
from .shapes import MAPPING, PlaceShape
from .spots import START

SECTION = "places"


def places(
    document: Document,
    cell: Place,
    roles: Mapping[str, Robot],
    spaces: Sequence[Workspace],
    groups: Mapping[str, Sequence[str]],
) -> tuple[PartPlace, ...]:
    """The places of a cell by target; a declaration of the target itself counts before that of its group."""
    here = (*cell, SECTION)
    if not document.has(here):
        return ()
    document.read_plain(MAPPING, here)
    targets = {name for space in spaces for name in space.targets} - {START}
    found: dict[str, PartPlace] = {}
    for name in sorted(document.keys(here), key=lambda name: name in targets):  # groups come first
        members = (name,) if name in targets else groups.get(name, ())
        if name not in targets and name not in groups:
            _refuse(document, (*here, name), [*sorted(targets), *groups])
        for member in members if _is_right(document, (*here, name), roles) else ():
            found[member] = _place(document, (*here, name), member, roles)
    return tuple(found.values())


def _refuse(document: Document, place: Place, known: Sequence[str]) -> None:
    name = str(place[-1])
    waits = f"{START} is where robots wait; no part lies there"
    there = (
        f"must be {choice(known)}, is {shown(name)}{nearest(name, known)}" if known else "there is no target"
    )
    document.problem(place, waits if name == START else there, at=place)


def _is_right(document: Document, place: Place, roles: Mapping[str, Robot]) -> bool:
    shape = document.read(PlaceShape, place)
    if shape is None:
        return False
    devices = [role for role, device in roles.items() if device.verb_names]
    if shape.of and shape.of not in devices:
        there = f"must be {choice(devices)}" if devices else "no device of this cell has verbs"
        document.problem((*place, "of"), f"{there}, is {shown(shape.of)}{nearest(shape.of, devices)}")
        return False
    if shape.supply and shape.output:
        document.problem((*place, "output"), "people fill a supply and empty an output; this is to be both")
        return False
    return True


def _place(document: Document, place: Place, target: str, roles: Mapping[str, Robot]) -> PartPlace:
    shape = document.read(PlaceShape, place) or PlaceShape()
    device = roles[shape.of].name if shape.of else None
    return PartPlace(
        target=target, holds=shape.holds, device=device, supply=shape.supply, output=shape.output
    )
