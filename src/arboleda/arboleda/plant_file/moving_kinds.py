"""Robots of kinds that `@moving_kind` made: their keys, which are those of any robot and settings."""

from __future__ import annotations

from dataclasses import fields
from functools import cache, wraps
from typing import Any

from pydantic import create_model

from arboleda.kinds import KindError, MovingKind
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain
from arboleda.model.plant_model import Robot

from .document import Document, Place
from .python_uses import LONGEST, KindInPython, refused
from .robot_kind import RobotKind
from .robots import check_homing, names_and_link
from .settings import keys
from .shapes import MovingDeviceShape


def as_read(kind: KindInPython | MovingKind) -> KindInPython:
    """The kind; one that moves with a function that reads the keys of its robots."""
    return _reader(kind) if isinstance(kind, MovingKind) else kind


@cache
def _reader(kind: MovingKind) -> RobotKind:
    @wraps(kind.function)
    def read(document: Document, place: Place) -> Robot | None:
        shape = document.read(_shape(kind), place)
        check_homing(document, place, shape)
        if shape is None:
            return None
        try:
            settings = _settings(kind, shape)
        except (ValueError, ArboledaError) as error:
            document.problem(place, plain(refused(error), LONGEST))
            return None
        named = names_and_link(document, shape, place)
        return kind.robot(settings, {**named, "timeout_s": shape.timeout_s})

    return RobotKind(name=kind.name, read=read, goes=True)


def _shape(kind: MovingKind) -> type[MovingDeviceShape]:
    rows = () if kind.settings is None else fields(kind.settings)
    taken = next((row.name for row in rows if row.name in MovingDeviceShape.model_fields), None)
    if taken is not None:
        raise KindError(f"{taken} is a key of every robot; give the field another name")
    return create_model(f"Robot_{kind.name}", __base__=MovingDeviceShape, **keys(kind.settings))


def _settings(kind: MovingKind, shape: MovingDeviceShape) -> Any:
    if kind.settings is None:
        return None
    return kind.settings(**{each.name: getattr(shape, each.name) for each in fields(kind.settings)})
