"""The fields of a settings dataclass as keys of a plant file."""

from __future__ import annotations

from dataclasses import MISSING, Field, fields
from enum import Enum
from functools import reduce
from operator import or_
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from pydantic import Field as Given

TYPES = "give bool, int, float, str, Literal, an Enum, and tuples of them"


def keys(settings: type | None) -> dict[str, Any]:
    """Each field with its type and its default, as `pydantic.create_model` takes them."""
    if settings is None:
        return {}
    hints = get_type_hints(settings, include_extras=True)
    return {row.name: _key(hints[row.name], row) for row in fields(settings)}


def _key(hint: Any, row: Field[Any]) -> tuple[Any, Any]:
    """A key of the plant file with its default; a list serves for a tuple, a word for an Enum."""
    default = ... if row.default is MISSING else row.default
    if row.default_factory is not MISSING:
        default = Given(default_factory=row.default_factory)
    return _as_in_a_file(hint), default


def _as_in_a_file(hint: Any) -> Any:
    """The type, where a list serves for a tuple and a word for an Enum."""
    if get_origin(hint) in (Union, UnionType):
        return reduce(or_, map(_as_in_a_file, get_args(hint)))
    is_tuple = get_origin(hint) is tuple or (isinstance(hint, type) and issubclass(hint, Enum))
    return Annotated[hint, Given(strict=False)] if is_tuple else hint
