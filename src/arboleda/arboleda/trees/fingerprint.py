"""Hash of all that a thing is made of, equal over starts of the plant: it tells what was made alike.

Functions count by their code and by what they have taken in, objects that are no data by their class alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, partial
from hashlib import blake2b
from types import CodeType, FunctionType, MethodType
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Sentence

Seen = dict[int, tuple[int, object]]
"""What was met, by its identity: its number, and itself, so that nothing else gets that identity."""
PLAIN = (str, int, float, bool, bytes, type(None))
PLAIN_TYPES = frozenset(PLAIN)
# What py_trees keeps in a node, what only shows how far it came, and what says the same as its name.
OF_NODES = frozenset(
    [
        "id",
        "name",
        "title",
        "doing",
        "told",
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
        "tries",
        "again_at",
        "patient_until",
        "until",
        "since",
        "done",
    ]
)
NO_MATTER = frozenset({"recipes", "queue_limit", "goes_on", "goes_on_after_absence"})  # of a cell


def joined(*words: str) -> str:
    """The hash of some words."""
    return blake2b("\n".join(words).encode(), digest_size=16).hexdigest()


def of_cell(cell: Cell, recipe: str, seen: Seen) -> str:
    """The hash of what the tasks of a recipe go by: its code, the devices of its cell, where they go."""
    build = next((each.build for each in cell.recipes if each.name == recipe), None)
    words: list[str] = []
    _spell(cell, seen, words)
    _spell(build, seen, words)
    return joined(*words)


def of_tree(root: Behaviour, seen: Seen) -> str:
    """The hash of a tree that nobody has ticked yet: its nodes, with what they were made of.

    What was `seen` in its cell is only named.
    """
    seen = dict(seen)
    words: list[str] = []
    for node in root.iterate():
        words += (type(node).__qualname__, node.name, str(len(node.children)))
        for key, value in vars(node).items():
            if key not in OF_NODES:
                words.append(key)
                _spell(value, seen, words)
    return joined(*words)


def _spell(value: Any, seen: Seen, words: list[str]) -> None:
    """Append the words of a value: one call for each, where nested generators take many."""
    if isinstance(value, Enum):
        words.append(f"{type(value).__qualname__}.{value.name}")
    elif isinstance(value, PLAIN) or (type(value) is tuple and PLAIN_TYPES.issuperset(map(type, value))):
        words.append(repr(value))
    elif id(value) in seen:
        words.append(f"see {seen[id(value)][0]}")
    else:
        seen[id(value)] = len(seen), value
        words.append(type(value).__qualname__)
        for part in _parts(value):
            _spell(part, seen, words)
        words.append(".")


def _parts(value: Any) -> Iterable[Any]:
    """The parts that a thing is made of; none of what is no data."""
    if isinstance(value, tuple | list):
        return value
    if isinstance(value, Mapping):
        return [part for pair in value.items() for part in pair]
    if isinstance(value, set | frozenset):
        return sorted(value, key=repr)
    if isinstance(value, Sentence):
        return value.key, value.values
    if (names := _fields(value.__class__)) is not None:
        return [getattr(value, name) for name in names]
    if isinstance(value, FunctionType):
        return value.__code__, value.__defaults__, *map(_content, value.__closure__ or ())
    if isinstance(value, MethodType):
        return (value.__func__,)
    if isinstance(value, partial):
        return value.func, value.args, value.keywords
    if isinstance(value, CodeType):
        return value.co_code, value.co_names, value.co_consts
    return ()


@cache
def _fields(kind: type) -> tuple[str, ...] | None:
    """The names of the fields that matter of a dataclass; None for any other class."""
    if not is_dataclass(kind):
        return None
    passed_over = NO_MATTER if issubclass(kind, Cell) else frozenset[str]()
    return tuple(each.name for each in fields(kind) if each.name not in passed_over)


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # nothing was put in yet
        return None
