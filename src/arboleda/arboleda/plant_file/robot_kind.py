"""A kind of devices that are more than facts and verbs, as an arm with its joints and its model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from arboleda.model.plant_model import Robot

from .document import Document, Place


@dataclass(frozen=True, kw_only=True)
class RobotKind:
    """A kind that reads by itself what a plant file says of a device, which it keeps the problems of.

    Those that `go` have targets, carry tools and belong to one cell. Those with a twin have a key `twin`:
    the name under which they are drawn.
    """

    name: str
    read: Callable[[Document, Place], Robot | None]
    goes: bool = False
    has_twin: bool = False
