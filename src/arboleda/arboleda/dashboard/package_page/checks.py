"""Checks of what a package declares for its page: each field has a value of its type."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import fields, is_dataclass
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

from arboleda.model.errors import ArboledaError
from arboleda.model.outside import quoted

from .items import Page, Tab

WRONG = "{field} is {value}; it takes {type}"
Spared = Callable[[str], AbstractContextManager[None]]
"""Time in which a piece of this name is looked at, and left out where it is wrong."""


def right(thing: Any, spared: Spared) -> Any:
    """The thing as it is declared; ArboledaError where it is wrong.

    Of a page each field that is wrong is left out alone, and so is each thing in a list of a page or a tab.
    """
    hints, given = get_type_hints(type(thing)), dict[str, Any]()
    for each in fields(thing):
        value, hint = getattr(thing, each.name), hints[each.name]
        with spared(f"the declaration {each.name} of the page") if isinstance(thing, Page) else nullcontext():
            if not _is_list(value) or not any(map(is_dataclass, value)):
                _require(value, hint, f"{each.name} of {_called(thing)}", each.type)
                given[each.name] = value
                continue
            given[each.name] = found = list[Any]()
            for inner in value:
                alone = isinstance(thing, Page | Tab)
                with spared(f"the declaration {_called(inner)}") if alone else nullcontext():
                    _require(inner, get_args(hint)[0], f"one of {each.name} of {_called(thing)}", each.type)
                    found.append(right(inner, spared))
    return type(thing)(**given)


def _require(value: object, hint: Any, field: str, type: object) -> None:
    if not _fits(value, hint):
        raise ArboledaError(WRONG.format(field=field, value=quoted(value), type=type))


def _called(thing: object) -> str:
    """A thing as people are told of it, as `Rows 'open'`."""
    if isinstance(thing, Page):
        return "the page"
    return f"{type(thing).__name__} {quoted(thing.name)}" if hasattr(thing, "name") else quoted(thing)


def _is_list(value: object) -> bool:
    """True for a list of any kind; a text and a mapping are none."""
    return isinstance(value, Collection) and not isinstance(value, str | bytes | Mapping)


def _fits(value: Any, hint: Any) -> bool:
    """True if a value is of a type, as a field of a page has it."""
    kind, of = get_origin(hint), get_args(hint)
    if kind in (Union, UnionType):
        return any(_fits(value, each) for each in of)
    if kind is Literal:
        return value in of
    if kind is Mapping:
        return isinstance(value, Mapping) and all(_fits(each, of[1]) for each in value.values())
    if kind is Sequence:
        return _is_list(value) and all(_fits(each, of[0]) for each in value)
    if kind is Callable:
        return callable(value)
    return isinstance(value, int | float if hint is float else hint)
