"""Types of ROS 2 as they are installed: what a path leads to in one, and messages made of values."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path
from typing import Any

from arboleda.drivers import DriverError, among, quoted
from arboleda_drivers.paths import FIELD, steps
from arboleda_drivers.ros_action.interfaces import interface

from .keys import NOW, Call, Fields

SENT = {"action": "Goal", "service": "Request"}
HEARD = {"action": "Result", "service": "Response"}
WHOLE = {f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)}
WHOLE |= {f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)}


def misspelt(name: str) -> str:
    """The sentence on a type that is not there; "" for one whose package is only not installed here."""
    package, kind, type = name.split("/")
    try:
        module = import_module(f"{package}.{kind}")
    except ImportError:
        places = (found for entry in sys.path for found in Path(entry).glob(f"*/{kind}/__init__.py"))
        near = get_close_matches(package, {found.parent.parent.name for found in places})
        has = [each for each in near if hasattr(import_module(f"{each}.{kind}"), type)]
        return f"there is no message package {package} here; did you mean {has[0]}?" if has else ""
    known = [each for each in vars(module) if each[0].isupper() and "_" not in each]
    return "" if type in known else f"{package} has no type {kind}/{type}; {among(type, known)}"


def message_of(call: Call, fields: Fields, now: object = None) -> Any:
    """The goal, request or message of a call; raises DriverError for a field or a value that does not fit.

    `now` stands where a field is `$now`.
    """
    type = interface(call.type)
    message = getattr(type, SENT[call.kind])() if call.kind in SENT else type()
    for path, value in fields.items():
        _set(message, path, value, now)
    return message


def heard_in(name: str, part: str, path: str) -> None:
    """Raises DriverError unless a path leads to a value in that part of a type, "" for the type itself."""
    type = interface(name)
    _refuse_whole(_slot_at(getattr(type, part) if part else type, steps(path, FIELD), path), path)


def _set(message: Any, path: str, value: Any, now: object) -> None:
    *way, last = steps(path, FIELD)
    slot = _slot_at(type(message), (*way, last), path)
    if isinstance(last, int):
        raise DriverError(f"{path} is one item of a list of values; give the list as a whole, [1, 2]")
    inner = message
    for at, step in enumerate(way, start=1):
        if isinstance(step, str):
            inner = getattr(inner, step)
            continue
        while len(inner) <= step:
            inner.append(_class(_slot_at(type(message), way[:at], path), path)())
        inner = inner[step]
    setattr(inner, last, _value(slot, path, value, now))


def _slot_at(owner: Any, way: Sequence[str | int], path: str) -> Any:
    """The type of the field to which the way leads, as ROS 2 declares it."""
    slot: Any = None
    for step in way:
        if isinstance(step, str):
            slot = _slot(owner if slot is None else _class(slot, path), step)
        elif not hasattr(slot, "value_type"):
            raise DriverError(f"{path}: a number in brackets is for lists, and this is none")
        else:
            slot = slot.value_type
    return slot


def _slot(type: Any, name: str) -> Any:
    known = dict(zip(type.get_fields_and_field_types(), type.SLOT_TYPES, strict=True))
    if name not in known:
        raise DriverError(f"{type.__name__} has no field {name}; {among(name, known)}")
    return known[name]


def _class(slot: Any, path: str) -> Any:
    if not hasattr(slot, "namespaces"):
        raise DriverError(f"{path} goes on after a value, which has no fields")
    return getattr(import_module(".".join(slot.namespaces)), slot.name)


def _refuse_whole(slot: Any, path: str) -> None:
    if hasattr(slot, "namespaces"):
        known = ", ".join(_class(slot, path).get_fields_and_field_types())
        raise DriverError(f"{path} is a {slot.name}; name a field of it: {known}")
    if hasattr(slot, "value_type"):
        raise DriverError(f"{path} is a list; name an item of it: {path}[0]")


def _value(slot: Any, path: str, value: Any, now: object) -> Any:
    """A value as a field of that type takes it."""
    if hasattr(slot, "value_type"):
        if not isinstance(value, list) or len(value) != getattr(slot, "size", len(value)):
            if hasattr(slot, "size"):
                raise DriverError(f"{path} is a list of {slot.size}; write [1, 2]")
            raise DriverError(f"{path} is a list; write [1, 2]")
        return [_value(slot.value_type, path, each, now) for each in value]
    if hasattr(slot, "namespaces"):
        if value == NOW and slot.name == "Time":
            return now if now is not None else _class(slot, path)()
        _refuse_whole(slot, path)
    of = getattr(slot, "typename", "string")
    if isinstance(value, int | float) and not isinstance(value, bool):
        low, high = WHOLE.get(of, (1, 0))
        if value == round(value) and low <= value <= high:
            return round(value)
        if of in ("float", "double"):
            return float(value)
    if isinstance(value, {"boolean": bool, "string": str}.get(of, ())):
        return value
    raise DriverError(f"{path} is {quoted(value)}, and its type is {of}")
