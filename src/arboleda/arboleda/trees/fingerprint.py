"""Hash of all that a thing is made of, equal over starts of the plant: it tells what was made alike.

Functions count by their code and by what they have taken in, objects that are no data by their class alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import partial
from hashlib import blake2b
from types import CodeType, FunctionType, MethodType
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.model.plant_model import Cell
from arboleda.model.sentence import Sentence

Seen = dict[int, tuple[int, object]]
"""What was met, by its identity: its number, and itself, so that nothing else gets that identity."""
PLAIN = (str, int, float, bool, bytes, type(None))
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
    return joined(*_words(cell, seen), *_words(build, seen))


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
                words += (key, *_words(value, seen))
    return joined(*words)


def _words(value: Any, seen: Seen) -> Iterator[str]:
    if isinstance(value, Enum):
        yield f"{type(value).__qualname__}.{value.name}"
    elif isinstance(value, PLAIN):
        yield repr(value)
    elif id(value) in seen:
        yield f"see {seen[id(value)][0]}"
    else:
        seen[id(value)] = len(seen), value
        yield type(value).__qualname__
        for part in _parts(value):
            yield from _words(part, seen)
        yield "."


def _parts(value: Any) -> Iterator[Any]:
    """The parts that a thing is made of; none of what is no data."""
    if isinstance(value, tuple | list):
        yield from value
    elif isinstance(value, Mapping):
        for key, each in value.items():
            yield key
            yield each
    elif isinstance(value, set | frozenset):
        yield from sorted(value, key=repr)
    elif isinstance(value, Sentence):
        yield value.key
        yield value.values
    elif isinstance(value, Cell):
        yield from (getattr(value, each.name) for each in fields(value) if each.name not in NO_MATTER)
    elif is_dataclass(value) and not isinstance(value, type):
        yield from (getattr(value, each.name) for each in fields(value))
    elif isinstance(value, FunctionType):
        yield value.__code__
        yield value.__defaults__
        yield from (_content(cell) for cell in value.__closure__ or ())
    elif isinstance(value, MethodType):
        yield value.__func__
    elif isinstance(value, partial):
        yield value.func
        yield value.args
        yield value.keywords
    elif isinstance(value, CodeType):
        yield value.co_code
        yield value.co_names
        yield value.co_consts


def _content(cell: Any) -> Any:
    try:
        return cell.cell_contents
    except ValueError:  # nothing was put in yet
        return None
