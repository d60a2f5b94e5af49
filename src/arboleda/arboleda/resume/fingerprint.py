"""Fingerprint of a tree or a cell: a hash of all that it is made of, which is equal over starts of the plant.

A function counts by its name, its defaults and its closure. The functions of a recipe count by the recipe's
source as well, which is equal in each Python, or by their code where the source is unknown. Objects that are
no data count by their class alone.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, partial
from hashlib import blake2b
from types import CodeType, FunctionType, MethodType
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.model.plant_model import Cell
from arboleda.model.recipe import FOR_PEOPLE
from arboleda.model.sentence import Sentence
from arboleda.model.tree_nodes import nodes_of

Seen = dict[int, tuple[int, object]]
"""By the identity of each value that was met: its number, and itself, so that its identity stays its own."""
Parts = Callable[[Any], Iterable[Any]]
BY_SOURCE = "source:"  # begins a hash of this version; a hash without it counts the code of functions
OURS = ("arboleda.", "arboleda_trees.")  # packages whose functions change with the version of the plant alone
PLAIN = (str, int, float, bool, bytes, type(None))
PLAIN_TYPES = frozenset(PLAIN)
# Attributes of py_trees, attributes that only show how far a node came, and those that repeat its name.
OF_NODES = frozenset(
    [
        "id",
        "name",
        "title",
        "doing",
        "feedback",
        "status",
        "iterator",
        "children",
        "parent",
        "logger",
        "context",
        "blackboards",
        "qualified_name",
        "blackbox_level",
        "feedback_message",
        "current_child",
        "entry",
        "may_have_left",
        "may_have_left_before",
        "last",
        "proven",
        "number_in_tree",
        "given_times",
        "given_earlier",
        "tries",
        "again_at",
        "patient_until",
        "until",
        "since",
        "done",
    ]
)
NO_MATTER = frozenset({"recipes", "queue_limit", "goes_on", "goes_on_after_absence", "teach"})  # of a cell


def joined(*words: str) -> str:
    return blake2b("\n".join(words).encode(), digest_size=16).hexdigest()


def of_cell(cell: Cell, recipe: str, seen: Seen, *, by_code: bool = False) -> str:
    """The hash of what a recipe's tasks depend on: its source, the devices of its cell, and their poses.

    `by_code`: with the code of every function, as earlier versions of Arboleda made it.
    """
    declared = next((each for each in cell.recipes if each.name == recipe), None)
    spelling = Spelling(seen, by_code=by_code, source="" if declared is None else declared.source)
    spelling.add(cell)
    spelling.add(None if declared is None else declared.build)
    return spelling.hash


def of_tree(root: Behaviour, seen: Seen, *, by_code: bool = False, source: str = "") -> str:
    """The hash of a tree that was never ticked: its nodes, with their attributes.

    Values that were `seen` in its cell count by their number. `source` is the source of its recipe.
    """
    spelling = Spelling(dict(seen), by_code=by_code, source=source)
    for node in nodes_of(root):
        spelling.words += (type(node).__qualname__, node.name, str(len(node.children)))
        for key, value in vars(node).items():
            if key not in OF_NODES:
                spelling.words.append(key)
                spelling.add(value)
    return spelling.hash


class Spelling:
    """Words that stand for values, one after the other; `source` says what names of functions mean."""

    def __init__(self, seen: Seen, *, by_code: bool, source: str) -> None:
        self.words = [source] if source and not by_code else []
        self._seen = seen
        self._by_code = by_code
        self._has_source = bool(source)

    @property
    def hash(self) -> str:
        """The hash of all words so far."""
        return joined(*self.words)

    def add(self, value: Any) -> None:
        """Append the words of a value."""
        kind = value.__class__
        if kind in PLAIN_TYPES:
            self.words.append(repr(value))
        elif (parts := _parts_of(kind)) is None:
            is_enum = isinstance(value, Enum)
            self.words.append(f"{kind.__qualname__}.{value.name}" if is_enum else repr(value))
        elif kind is tuple and PLAIN_TYPES.issuperset(map(type, value)):
            self.words.append(repr(value))
        elif id(value) in self._seen:
            self.words.append(f"see {self._seen[id(value)][0]}")
        else:
            self._add_parts(value, kind, parts)

    def _add_parts(self, value: Any, kind: type, parts: Parts) -> None:
        """Append the words of a value with parts, without a call for each word: a tree has thousands."""
        self._seen[id(value)] = len(self._seen), value
        words = self.words
        words.append(kind.__qualname__)
        if kind is FunctionType and not self._counts_code(value):
            parts = _named
        for part in parts(value):
            if type(part) in PLAIN_TYPES:
                words.append(repr(part))
            else:
                self.add(part)
        words.append(".")

    def _counts_code(self, function: FunctionType) -> bool:
        is_known = self._has_source or (function.__module__ or "").startswith(OURS)
        return self._by_code or not is_known


@cache
def _parts_of(kind: type) -> Parts | None:
    """The function that takes the values of a class apart; None where a value is one word."""
    if issubclass(kind, (Enum, *PLAIN)):
        return None
    if issubclass(kind, Sentence):
        return _of_sentence
    if is_dataclass(kind) and not issubclass(kind, tuple | list | Mapping | set | frozenset):
        return partial(_of_fields, _fields(kind))
    return next((parts for base, parts in PARTS if issubclass(kind, base)), _nothing)


def _of_fields(names: tuple[str, ...], value: Any) -> list[Any]:
    return [getattr(value, name) for name in names]


def _fields(kind: type) -> tuple[str, ...]:
    passed_over = NO_MATTER if issubclass(kind, Cell) else frozenset[str]()
    counted = (each for each in fields(kind) if not each.metadata.get(FOR_PEOPLE))
    return tuple(each.name for each in counted if each.name not in passed_over)


def _of_sentence(value: Sentence) -> tuple[Any, ...]:
    return value.key, value.values


def _pairs(value: Mapping[Any, Any]) -> list[Any]:
    return [part for pair in value.items() for part in pair]


def _in_order(value: Iterable[Any]) -> list[Any]:
    return sorted(value, key=repr)


def _coded(value: FunctionType) -> tuple[Any, ...]:
    return value.__code__, value.__defaults__, *map(_content, value.__closure__ or ())


def _named(value: FunctionType) -> tuple[Any, ...]:
    return value.__qualname__, value.__defaults__, *map(_content, value.__closure__ or ())


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # nothing was put in yet
        return None


def _nothing(value: object) -> tuple[Any, ...]:
    return ()


PARTS: tuple[tuple[Any, Parts], ...] = (
    (tuple | list, iter),
    (Mapping, _pairs),
    (set | frozenset, _in_order),
    (FunctionType, _coded),
    (MethodType, lambda value: (value.__func__,)),
    (partial, lambda value: (value.func, value.args, value.keywords)),
    (CodeType, lambda value: (value.co_code, value.co_names, value.co_consts)),
)
