"""Calls of what recipes are made of with names or numbers of values that it does not take."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any

from arboleda import drivers, kinds, recipes
from arboleda.model.outside import among, quoted
from arboleda.recipes.errors import Offers

CALL = re.compile(r"(?:(?P<owner>\w+)\.)?(?P<name>\w+)\(\) (?P<what>.+)")
UNEXPECTED = re.compile(r"got an unexpected keyword argument '(\w+)'")
MISSING = re.compile(r"missing \d+ required (?:positional|keyword-only) arguments?: (.+)")

NAMED = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


def wrong_call(error: TypeError) -> str | None:
    """The sentence for a call that does not fit; None for any other error, and for a call of other code."""
    match = CALL.match(str(error))
    called = None if match is None else _called(match["owner"], match["name"])
    if match is None or called is None:
        return None
    name, taken = match["name"], _taken(called)
    if unexpected := UNEXPECTED.match(match["what"]):
        return f"{name} takes no {quoted(unexpected[1])}; {among(unexpected[1], list(taken))}"
    form = f"{name}({', '.join(taken.values())})"
    if missing := MISSING.match(match["what"]):
        return f"{name} is not given {missing[1].replace(chr(39), '')}; it is {form}"
    return f"{name} is given too many values; it is {form}"


def _called(owner: str | None, name: str) -> Callable[..., Any] | None:
    """The function that a recipe, kind or driver calls by this name."""
    if owner is None:
        rooms: tuple[Any, ...] = (recipes, kinds, drivers)
        return next((getattr(room, name) for room in rooms if name in room.__all__), None)
    owners = [kind for kind in _offers(Offers) if kind.__name__ == owner]
    return getattr(owners[0], name, None) if owners else None


def _offers(kind: type[Offers]) -> Iterator[type[Offers]]:
    below: list[type[Offers]] = kind.__subclasses__()
    for each in below:
        yield each
        yield from _offers(each)


def _taken(called: Callable[..., Any]) -> dict[str, str]:
    """The parameters of a function by name, each as a call writes it."""
    parameters = inspect.signature(called).parameters.values()
    named = [each for each in parameters if each.name != "self" and each.kind in NAMED]
    return {each.name: f"{each.name}=..." if each.kind is each.KEYWORD_ONLY else each.name for each in named}
