"""Needs across the devices of a cell: facts of one device without which another is not told to do a verb."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from arboleda.model.commands import GO, GRIP, LET_GO
from arboleda.model.facts import Value
from arboleda.model.plant_model import Need, Robot

from .declared_kinds import verbs_of
from .document import Document, Place, choice, misnamed, nearest, shown
from .shapes import MAPPING

SECTION = "needs"
Roles = Mapping[str, Any]  # robots; those that have verbs have a kind


def needs(document: Document, cell: Place, roles: Roles) -> tuple[Need, ...]:
    """The needs of a cell: those of its section `needs`, and those of the kinds of its devices."""
    return (*_of_kinds(document, cell, roles), *_of_section(document, cell, roles))


def _of_kinds(document: Document, cell: Place, roles: Roles) -> Iterator[Need]:
    for role, device in roles.items():
        for verb in verbs_of(device).values():
            for name, value in verb.needs_of_others:
                place = (*cell, "devices", role)
                what = f"{verb.name} of {device.kind_name} needs {name}: "
                need = _other(document, place, roles, role, name, value, what)
                if need is not None:
                    other, fact, value = need
                    yield Need(device=device.name, word=verb.name, other=other, fact=fact, value=value)


def _of_section(document: Document, cell: Place, roles: Roles) -> Iterator[Need]:
    here = (*cell, SECTION)
    if not document.has(here):
        return
    document.read_plain(MAPPING, here)
    for key in document.keys(here):
        role, _, word = key.partition(".")
        place = (*here, key)
        if not _is_verb(document, place, roles, role, word):
            continue
        document.read_plain(MAPPING, place)
        for name in document.keys(place):
            value = document.value((*place, name))
            need = _other(document, (*place, name), roles, role, name, value, "")
            if need is not None:
                other, fact, value = need
                yield Need(device=roles[role].name, word=word, other=other, fact=fact, value=value)


def _is_verb(document: Document, place: Place, roles: Roles, role: str, word: str) -> bool:
    """True if the device in a role has that verb; else the problem is kept."""
    if role not in roles:
        there = f'must be a role and one of its verbs, as "{next(iter(roles))}.close"; there is no role'
        document.problem(place, f"{there} {shown(role)}{nearest(role, roles)}", at=place)
        return False
    words = _words(roles[role])
    if word not in words:
        there = f"verbs of {role} are {choice(words)}" if words else f"{role} is told no verb"
        document.problem(place, f"{there}, is {shown(word)}{nearest(word, words)}", at=place)
    return word in words


def _words(robot: Robot) -> list[str]:
    """The verbs of a device, or of a robot that goes."""
    if not robot.goes:
        return list(robot.verb_names)
    return [GO, *([GRIP, LET_GO] if robot.held_fact else [])]


def _other(
    document: Document, place: Place, roles: Roles, role: str, name: str, value: object, what: str
) -> tuple[str, str, Value] | None:
    """The device, fact and value of a need that is written "reader.lid".

    None, with the problem kept, where there is no such fact, or the fact cannot have this value.
    """
    facts = {
        f"{other}.{fact}": (device, fact)
        for other, device in roles.items()
        if device.verb_names and other != role
        for fact in device.kind.facts
    }
    owner, _, own = name.partition(".")
    if owner == role and own in getattr(roles[role].kind, "facts", ()):
        kind = f"as needs: {{{own}: {shown(value)}}} of the verb in its kind, {roles[role].kind_name}"
        document.problem(place, f"{what}{own} is a fact of {role} itself; say that {kind}", at=place)
        return None
    if name not in facts:
        sentence = misnamed(name, facts, "no other device of this cell reports facts")
        document.problem(place, f"{what}{sentence}", at=place)
        return None
    device, fact = facts[name]
    read = device.kind.facts[fact].read(value)
    if read is None:
        allowed = device.kind.facts[fact].allowed()
        document.problem(place, f"{what}{fact} of {device.name} must be {allowed}, is {shown(value)}")
        return None
    return device.name, fact, read
