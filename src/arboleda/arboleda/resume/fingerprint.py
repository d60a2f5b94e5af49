"""Hash of all that a thing is made of, equal over starts of the plant: it tells what was made alike.

Functions count by their names and by what they have taken in, and those of a recipe by its source beside,
which is the same in each Python; where that is unknown, they count by their code. Objects that are no data
count by their class alone.
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
"""What was met, by its identity: its number, and itself, so that nothing else gets that identity."""
Parts = Callable[[Any], Iterable[Any]]
BY_SOURCE = "source:"  # before a hash of this version; one without it was made when all went by code
OURS = "arboleda."  # packages whose functions change with the version of the plant alone
PLAIN = (str, int, float, bool, bytes, type(None))
PLAIN_TYPES = frozenset(PLAIN)
# What py_trees keeps in a node, what only shows how far it came, and what says the same as its name.
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
        "left",
        "left_before",
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
    """The hash of some words."""
    return blake2b("\n".join(words).encode(), digest_size=16).hexdigest()


def of_cell(cell: Cell, recipe: str, known: Seen, *, by_code: bool = False) -> str:
    """The hash of what the tasks of a recipe go by: its source, the devices of its cell, where they go.

    `by_code` as it was made once, when the code of every function counted.
    """
    found = next((each for each in cell.recipes if each.name == recipe), None)
    spelling = Spelling(known, by_code=by_code, source="" if found is None else found.source)
    spelling.add(cell)
    spelling.add(None if found is None else found.build)
    return spelling.hash


def of_tree(root: Behaviour, known: Seen, *, by_code: bool = False, source: str = "") -> str:
    """The hash of a tree that nobody has ticked yet: its nodes, with what they were made of.

    What was `seen` in its cell is only named. `source` is that of its recipe.
    """
    spelling = Spelling(dict(known), by_code=by_code, source=source)
    for node in nodes_of(root):
        spelling.words += (type(node).__qualname__, node.name, str(len(node.children)))
        for key, value in vars(node).items():
            if key not in OF_NODES:
                spelling.words.append(key)
                spelling.add(value)
    return spelling.hash


class Spelling:
    """Words of values, one after the other; with `source` they say what names of functions mean."""

    def __init__(self, known: Seen, *, by_code: bool, source: str) -> None:
        self.words = [source] if source and not by_code else []
        self._known = known
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
        elif id(value) in self._known:
            self.words.append(f"see {self._known[id(value)][0]}")
        else:
            self._add_parts(value, kind, parts)

    def _add_parts(self, value: Any, kind: type, parts: Parts) -> None:
        """A call for each value that has parts, and none for each word: a tree has thousands."""
        self._known[id(value)] = len(self._known), value
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
    """The function that takes a class's values apart; None where a value is a word."""
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
    """The names of the fields of a dataclass that matter."""
    passed_over = NO_MATTER if issubclass(kind, Cell) else frozenset[str]()
    found = (each for each in fields(kind) if not each.metadata.get(FOR_PEOPLE))
    return tuple(each.name for each in found if each.name not in passed_over)


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
