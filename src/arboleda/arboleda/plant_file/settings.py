"""Fields of a dataclass of settings as keys of a plant file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from functools import reduce
from operator import or_
from types import UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin, get_type_hints

from pydantic import Field as PydanticField
from pydantic import create_model

from arboleda.kinds import KindError, MovingKind, WrittenKind

from .document import Document, Place
from .robot_models import Shape

M = TypeVar("M", bound=Shape)
TYPES = "give bool, int, float, str, Literal, an Enum, and tuples of them"


class SettingsRefused(Exception):
    """A dataclass of settings refused the values at `place`, by `error`."""

    def __init__(self, place: Place, error: Exception) -> None:
        super().__init__(str(error))
        self.place = place
        self.error = error


def shape(name: str, settings: type) -> type[Shape]:
    """The shape of the plant file's mapping for these settings."""
    hints = get_type_hints(settings)
    outer = {name: (_outer(hints[name], key[0]), key[1]) for name, key in keys(settings).items()}
    return _built(name, Shape, outer)


def _built(name: str, base: type[M], own: dict[str, Any]) -> type[M]:
    """The shape with these keys too; PydanticSchemaGenerationError for a type that no plant file can give."""
    made: type[M] = create_model(name, __base__=base, **own)
    made.model_rebuild()  # not deferred as that of other shapes: it is the type that is looked at here
    return made


def read(document: Document, place: Place, fits: type[Shape], settings: type) -> Any:
    """The settings, with the settings inside them; None, with the problems kept, if they do not fit.

    SettingsRefused if a dataclass refuses the values.
    """
    read = document.read(fits, place)
    return None if read is None else _made(document, place, settings, dict(read))


def _made(document: Document, place: Place, settings: type, values: dict[str, Any]) -> Any:
    hints = get_type_hints(settings)
    made = {
        name: _inside(document, (*place, name), hints[name], value) if document.has((*place, name)) else value
        for name, value in values.items()
    }
    if None in [made[name] for name in values if document.value((*place, name)) is not None]:
        return None
    try:
        return settings(**made)
    except Exception as error:  # it is user code: whatever it raises is told
        raise SettingsRefused(place, error) from error


def _inside(document: Document, place: Place, hint: Any, value: Any) -> Any:
    """A value with its mappings made into the dataclasses of its type; None for a value that does not fit."""
    inner = next(_dataclasses(hint), None)
    if inner is None or value is None:
        return value
    if get_origin(hint) in (Union, UnionType):
        return _inside(document, place, inner, value) if isinstance(value, dict) else value
    if hint is inner:
        return read(document, place, shape(inner.__name__, inner), inner)
    within = get_args(hint)[-1 if get_origin(hint) is dict else 0]
    rows = value.items() if isinstance(value, dict) else enumerate(value)
    made = {key: _inside(document, (*place, key), within, row) for key, row in rows}
    if None in made.values():
        return None
    return made if isinstance(value, dict) else tuple(made.values())


def _outer(hint: Any, written: Any) -> Any:
    """The type of a key, in which mappings may have any keys: these are read by a shape of their own."""
    if next(_dataclasses(hint), None) is None:
        return written
    if get_origin(hint) in (Union, UnionType):
        others = [each for each in get_args(hint) if not is_dataclass(each) and each is not type(None)]
        return Any if others else dict[str, Any] | None
    return list[Any] if get_origin(hint) is tuple else dict[str, Any]


def _dataclasses(hint: Any) -> Iterator[type]:
    """The dataclasses in a type."""
    if isinstance(hint, type) and is_dataclass(hint):
        yield hint
    for each in get_args(hint):
        yield from _dataclasses(each)


def shape_of_kind(kind: WrittenKind | MovingKind, base: type[M], clash: str) -> type[M]:
    """The keys of a device of this kind: those of `base`, and the kind's settings.

    KindError with the sentence `clash` if a field of the settings has the name of a key of `base`.
    """
    own = keys(kind.settings)
    taken = next((name for name in own if name in base.model_fields), None)
    if taken is not None:
        raise KindError(clash.format(taken))
    return _built(f"Device_{kind.name}", base, own)


def settings_of_kind(kind: WrittenKind | MovingKind, shape: Shape) -> Any:
    """The settings of a device as its kind takes them; None for a kind without settings."""
    if kind.settings is None:
        return None
    return kind.settings(**{each.name: getattr(shape, each.name) for each in fields(kind.settings)})


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
        default = PydanticField(default_factory=row.default_factory)
    return _as_in_a_file(hint), default


def _as_in_a_file(hint: Any) -> Any:
    """The type as a file has it: a list in place of a tuple, a word in place of an Enum."""
    if get_origin(hint) in (Union, UnionType):
        return reduce(or_, map(_as_in_a_file, get_args(hint)))
    is_tuple = get_origin(hint) is tuple or (isinstance(hint, type) and issubclass(hint, Enum))
    return Annotated[hint, PydanticField(strict=False)] if is_tuple else hint
