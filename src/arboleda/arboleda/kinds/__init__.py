"""Kinds of devices and robots of your own: `@kind` and `@moving_kind` make one of a function of settings."""

from .authoring import Kind, WrittenKind, kind
from .moving import Axes, Axis, GridDrive, MovingKind, moving_kind
from .verbs import KindError, Number, Verb, motion, process, query, switch

__all__ = [
    "Axes",
    "Axis",
    "GridDrive",
    "Kind",
    "KindError",
    "MovingKind",
    "Number",
    "Verb",
    "WrittenKind",
    "kind",
    "motion",
    "moving_kind",
    "process",
    "query",
    "switch",
]
