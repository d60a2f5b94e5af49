"""JSON as the types of answers; keys that a type does not have are left out, as a plant may say more."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints


def read(wanted: Any, data: Any) -> Any:
    """`data` as the type `wanted`; raises ValueError where it is something else."""
    if isinstance(wanted, type) and is_dataclass(wanted):
        return _row(wanted, data)
    of = get_origin(wanted)
    if of in (Union, UnionType):
        return None if data is None else read(_one(wanted), data)
    if isinstance(of, type) and issubclass(of, list):
        _check(data, list)
        return of(read(get_args(wanted)[0], each) for each in data)
    if of is dict:
        _check(data, dict)
        return {name: read(get_args(wanted)[1], each) for name, each in data.items()}
    return data


def _row(wanted: Any, data: Any) -> Any:
    _check(data, Mapping)
    hints = _hints(wanted)
    known = {each.name for each in fields(wanted)} & data.keys()
    try:
        return wanted(**{name: read(hints[name], data[name]) for name in known})
    except TypeError as error:  # a key is missing
        raise ValueError(str(error)) from error


def _one(union: Any) -> Any:
    """The only type beside None; Any where there are several, which are plain."""
    others = [each for each in get_args(union) if each is not type(None)]
    return others[0] if len(others) == 1 else Any


def _check(data: Any, wanted: type) -> None:
    if not isinstance(data, wanted):
        raise ValueError(f"{type(data).__name__} is no {wanted.__name__}")


@cache
def _hints(wanted: Any) -> dict[str, Any]:
    return get_type_hints(wanted)
