"""Places of a cell of devices: the targets at which parts lie, and how many parts each can hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from arboleda.model.plant_model import Place as PartPlace
from arboleda.model.plant_model import Robot, Workspace

from .document import Document, Place, misnamed
from .shapes import MAPPING, PlaceShape
from .target_pose import START

SECTION = "places"


def places(
    document: Document,
    cell: Place,
    roles: Mapping[str, Robot],
    spaces: Sequence[Workspace],
    groups: Mapping[str, Sequence[str]],
) -> tuple[PartPlace, ...]:
    """The places of a cell; for a target that has a row of its own, the row of its group does not count."""
    here = (*cell, SECTION)
    if not document.has(here):
        return ()
    document.read_plain(MAPPING, here)
    targets = {name for space in spaces for name in space.targets} - {START}
    by_target: dict[str, PartPlace] = {}
    for name in sorted(document.keys(here), key=lambda name: name in targets):  # groups come first
        members = (name,) if name in targets else groups.get(name, ())
        if name not in targets and name not in groups:
            _refuse(document, (*here, name), [*sorted(targets), *groups])
        for member in members if _is_right(document, (*here, name), roles) else ():
            by_target[member] = _place(document, (*here, name), member, roles)
    return tuple(by_target.values())


def _refuse(document: Document, place: Place, allowed: Sequence[str]) -> None:
    name = str(place[-1])
    sentence = misnamed(name, allowed, "") if allowed else "there is no target"
    waits = f"{START} is where robots wait; no part lies there"
    document.problem(place, waits if name == START else sentence, at=place)


def _is_right(document: Document, place: Place, roles: Mapping[str, Robot]) -> bool:
    shape = document.read(PlaceShape, place)
    if shape is None:
        return False
    devices = [role for role, device in roles.items() if device.verb_names]
    if shape.of and shape.of not in devices:
        document.problem((*place, "of"), misnamed(shape.of, devices, "no device of this cell has verbs"))
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
