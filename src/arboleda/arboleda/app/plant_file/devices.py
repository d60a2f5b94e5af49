"""Cells that are made of devices by role: robots, and devices of kinds that the plant file declares."""

from __future__ import annotations

from collections.abc import Mapping

from arboleda.core.model import Cell, Evidence, Link, Retry, Robot
from arboleda.kinds.declared import Device, DeviceKind, DeviceVerb, Effect
from arboleda.kinds.person import person
from arboleda.wire import fit

from . import targets
from .deadlines import ROUNDING_S, SHOWN_S
from .document import Document, Place, choice, nearest, shown
from .kinds import RESERVED
from .robots import arm, arm_model, mobile
from .shapes import (
    NAME_RULE,
    ArmDeviceShape,
    DeviceCellShape,
    DeviceShape,
    MobileDeviceShape,
    PersonShape,
    RetryShape,
    is_name,
)

CELLS: Place = ("cells",)
PERSON = "person"
OF_ROBOTS = ARM, MOBILE = ("arm", "mobile")
EVIDENCE = {"facts": Evidence.JOINTS}  # what joints are to an arm


def is_of_devices(document: Document, place: Place) -> bool:
    """Whether a cell is one of devices, going by its keys."""
    has = document.keys(place)
    return "devices" in has or (document.has(("kinds",)) and not any(key in has for key in OF_ROBOTS))


def device_cell(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> Cell | None:
    """The cell, still without recipes; None, with its problems kept, where something is wrong with it."""
    both = [key for key in OF_ROBOTS if document.has((*place, key))]
    for key in both:
        rule = 'a cell has either "arm" and "mobile" or "devices"'
        what = f'{rule}; as one of its devices, it is "{key}: {{kind: {key}, ...}}"'
        document.problem((*place, key), what, at=(*place, key))
    shape = None if both else document.read(DeviceCellShape, place)
    retry = document.read(RetryShape, (*place, "retry")) if document.has((*place, "retry")) else RetryShape()
    names = document.keys((*place, "devices"))
    found = {role: _device(document, (*place, "devices", role), kinds) for role in names}
    members = {role: device for role, device in found.items() if device is not None}
    tools = _tools(document, (*place, "devices"), members)
    if shape is None or retry is None or len(members) < len(found):
        return None
    spaces = targets.workspaces(document, place, members, tools)
    if spaces is None:
        return None
    return Cell(
        name=str(place[-1]),
        members=tuple(members.items()),
        spaces=spaces,
        arrays=targets.groups(document, place, spaces),
        queue_limit=shape.queue_limit,
        zone_wait_s=shape.zone_wait_s,
        retry=Retry(**retry.model_dump()),
    )


def _tools(document: Document, place: Place, members: Mapping[str, Robot]) -> dict[str, Robot]:
    """The devices that robots carry, by the role of the robot."""
    tools: dict[str, Robot] = {}
    robots = [role for role in members if document.value((*place, role, "kind")) in OF_ROBOTS]
    for role, device in members.items():
        here = (*place, role, "tool_of")
        carrier = document.value(here) if role not in robots and document.has(here) else None
        if carrier is None:
            continue
        if carrier not in robots:
            there = f"must be {choice(robots)}" if robots else "no device of this cell is a robot"
            document.problem(here, f"{there}, is {shown(carrier)}{nearest(str(carrier), robots)}")
        elif device.held_fact is None:
            document.problem(here, f"{role} holds no part: none of its verbs has holds: part")
        elif carrier in tools:
            document.problem(here, f"{carrier} carries {tools[carrier].name} already")
        else:
            tools[carrier] = device
    return tools


def _device(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> Robot | None:
    role, kind = str(place[-1]), document.value((*place, "kind"))
    if not is_name(role):
        document.problem(place, f"a role must be {NAME_RULE}", at=place)
        return None
    if kind == ARM:
        return arm(document, place, arm_model(document, place), ArmDeviceShape)
    if kind == PERSON:
        named = document.read(PersonShape, place)
        return None if named is None else person(named.name or role)
    if kind == MOBILE:
        return mobile(document, place, MobileDeviceShape)
    return _declared(document, place, kinds)


def _declared(document: Document, place: Place, kinds: Mapping[str, DeviceKind]) -> Device | None:
    shape = document.read(DeviceShape, place)
    kind = _kind(document, (*place, "kind"), kinds)
    if shape is None or kind is None:
        return None
    evidence = EVIDENCE.get(shape.evidence) or Evidence(shape.evidence)
    name = shape.name or str(place[-1])
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
    known = [*declared, *RESERVED]
    hint = nearest(name, known)
    if not declared and not hint:
        document.problem(
            place, f'there is no kind {shown(name)}; declare it under "kinds" at the top of the file'
        )
    else:
        document.problem(place, f"must be {choice(known)}, is {shown(name)}{hint}")
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
