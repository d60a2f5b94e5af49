"""Robots of kinds that `@moving_kind` made: their keys are those of any robot, and the kind's settings."""

from __future__ import annotations

from functools import cache, wraps

from arboleda.kinds import MovingKind
from arboleda.model.errors import ArboledaError
from arboleda.model.outside import plain
from arboleda.model.plant_model import Robot

from .document import Document, Place
from .python_uses import LONGEST, KindInPython, refused
from .robot_kind import RobotKind
from .robots import check_homing, names_and_link
from .settings import settings_of_kind, shape_of_kind
from .shapes import MovingDeviceShape

CLASH = "{} is a key of every robot; give the field another name"


def as_read(kind: KindInPython | MovingKind) -> KindInPython:
    """The kind; one that `@moving_kind` made, as a kind that reads the keys of its robots."""
    return _reader(kind) if isinstance(kind, MovingKind) else kind


@cache
def _reader(kind: MovingKind) -> RobotKind:
    @wraps(kind.function)
    def read(document: Document, place: Place) -> Robot | None:
        shape = document.read(shape_of_kind(kind, MovingDeviceShape, CLASH), place)
        check_homing(document, place, shape)
        if shape is None:
            return None
        try:
            settings = settings_of_kind(kind, shape)
        except (ValueError, ArboledaError) as error:
            document.problem(place, plain(refused(error), LONGEST))
            return None
        named = names_and_link(document, shape, place)
        return kind.robot(settings, {**named, "timeout_s": shape.timeout_s})

    return RobotKind(name=kind.name, read=read, goes=True)
