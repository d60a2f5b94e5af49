"""Interface of a kind whose devices are more than facts and verbs, such as arms with joints and models."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from arboleda.model.plant_model import Robot

from .document import Document, Place


@dataclass(frozen=True, kw_only=True)
class RobotKind:
    """A kind that reads the keys of its devices by itself, and keeps their problems.

    Devices of a kind that `goes` have targets, carry tools and belong to one cell. Devices of a kind that
    `has_twin` have a key `twin`: the name under which they are drawn.
    """

    name: str
    read: Callable[[Document, Place], Robot | None]
    goes: bool = False
    has_twin: bool = False
