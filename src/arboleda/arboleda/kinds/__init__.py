"""Kinds of devices; with `@kind`, a function of settings makes a kind of your own."""

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
