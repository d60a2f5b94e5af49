"""Kinds of devices; `@kind` makes one of one's own of a function of its settings."""

from .authoring import Kind, WrittenKind, kind
from .verbs import KindError, Number, Verb, motion, process, query, switch

__all__ = [
    "Kind",
    "KindError",
    "Number",
    "Verb",
    "WrittenKind",
    "kind",
    "motion",
    "process",
    "query",
    "switch",
]
