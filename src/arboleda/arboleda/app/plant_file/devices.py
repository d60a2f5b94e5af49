"""Cells that are made of devices by role, each of a kind that the plant file declares."""

from __future__ import annotations

from collections.abc import Mapping

from arboleda.core.model import Cell, Evidence, Link, Retry
from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect
from arboleda.wire import fit

from .deadlines import ROUNDING_S, SHOWN_S
from .document import Document, Place, choice, nearest, shown
from .kinds import RESERVED
from .shapes import NAME_RULE, DeviceCellShape, DeviceShape, RetryShape, is_name

CELLS: Place = ("cells",)
OF_ROBOTS = ("arm", "mobile")
EVIDENCE = {"facts": Evidence.JOINTS}  # what joints are to an arm


def is_of_devices(document: Document, place: Place) -> bool:
    """Whether a cell is one of devices, going by its keys."""
    has = document.keys(place)
    return "devices" in has or (document.has(("kinds",)) and not any(key in has for key in OF_ROBOTS))


def device_cell(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> Cell | None:
    """The cell, still without recipes; None, with its problems kept, where something is wrong with it."""
    both = [key for key in OF_ROBOTS if document.has((*place, key))]
    for key in both:
        rule = f'a cell has either "{OF_ROBOTS[0]}" and "{OF_ROBOTS[1]}" or "devices"'
        document.problem((*place, key), f"{rule}; both together are not possible yet", at=(*place, key))
    shape = None if both else document.read(DeviceCellShape, place)
    retry = document.read(RetryShape, (*place, "retry")) if document.has((*place, "retry")) else RetryShape()
    roles = document.keys((*place, "devices"))
    found = [(role, _device(document, (*place, "devices", role), kinds)) for role in roles]
    members = tuple((role, device) for role, device in found if device is not None)
    if shape is None or retry is None or len(members) < len(found):
        return None
    return Cell(
        name=str(place[-1]),
        members=members,
        queue_limit=shape.queue_limit,
        retry=Retry(**retry.model_dump()),
    )


def _device(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> Device | None:
    role = str(place[-1])
    if not is_name(role):
        document.problem(place, f"a role must be {NAME_RULE}", at=place)
    shape = document.read(DeviceShape, place)
    kind = _kind(document, (*place, "kind"), kinds)
    if shape is None or kind is None or not is_name(role):
        return None
    evidence = EVIDENCE.get(shape.evidence) or Evidence(shape.evidence)
    name = shape.name or role
    proven = [_is_proven(document, place, kind, verb, evidence) for verb in kind.verbs.values()]
    if not all(proven) or not _fits(document, (*place, "kind"), kind):
        return None
    return Device(
        name=name,
        mqtt=shape.mqtt or name,
        link=Link.MQTT,
        evidence=evidence,
        timeout_s=max(verb.at_most_s for verb in kind.verbs.values()),
        has_stop=shape.stop == "supported",
        kind=kind,
    )


def _kind(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> DeviceKind | None:
    """The kind of that name; of a misspelt or a broken one None, with the problem kept."""
    name, declared = document.value(place), document.keys(("kinds",))
    if not isinstance(name, str) or name in declared:
        return kinds.get(name) if isinstance(name, str) else None
    if name in RESERVED:
        document.problem(
            place, f'{shown(name)} is not possible under "devices" yet; write "{name}:" in the cell'
        )
    elif not declared:
        document.problem(
            place, f'there is no kind {shown(name)}; declare it under "kinds" at the top of the file'
        )
    else:
        document.problem(place, f"must be {choice(declared)}, is {shown(name)}{nearest(name, declared)}")
    return None


def _fits(document: Document, place: Place, kind: DeviceKind) -> bool:
    """Whether its board can be told and can say all that the kind has, in messages as MQTT has them here."""
    objections = fit.objections(kind)
    for objection in objections:
        document.problem(place, objection)
    return not objections


def _is_proven(
    document: Document, place: Place, kind: DeviceKind, verb: DeviceVerb, evidence: Evidence
) -> bool:
    """Whether reports of a device of this evidence can show that a verb is done, in the time that it has."""
    here = (*place, "evidence")
    spare_s, needed_s = verb.at_most_s - verb.takes_s, SHOWN_S[evidence]
    if verb.effect is Effect.QUERY and evidence is not Evidence.IDS:
        why = f"{verb.name} of {kind.name} is a query, and its answer has to name the command"
        document.problem(here, f"must be ids: {why}")
    elif verb.effect is Effect.MOTION and evidence is Evidence.JOINTS and not verb.sets:
        document.problem(here, f"facts cannot prove {verb.name} of {kind.name}: it sets none")
    elif spare_s < needed_s - ROUNDING_S:
        what = (
            f"{verb.name} of {kind.name} takes {verb.takes_s:g} s and has an at_most_s of {verb.at_most_s:g}"
        )
        document.problem(place, f"{what}; its end may show {needed_s:g} s later, so give it that much more")
    else:
        return True
    return False
