"""Ways of a choice by a number: ranges of which each possible number has exactly one."""

from __future__ import annotations

from collections.abc import Collection

from arboleda.kinds.declared import FactType
from arboleda.kinds.ranges import FORMS, Range, apart, comparison, exactly, spelled
from arboleda.model.facts import Value
from arboleda.model.outside import quoted

from .errors import RecipeError

OTHERWISE = "otherwise"


def read(asked: str, type: FactType, keys: Collection[Value]) -> list[Range]:
    """The ranges of a choice, in the order of its keys; RecipeError unless each number has one of them."""
    named = tuple(_range(asked, type, key) for key in keys if key != OTHERWISE)
    numbers = apart(type, named)
    for number in numbers:
        _check(asked, number, [each for each in named if each.has(number)], is_covered=OTHERWISE in keys)
    others = Range(text=OTHERWISE, others=named)
    in_order = iter(named)
    ranges = [others if key == OTHERWISE else next(in_order) for key in keys]
    never = next((each for each in ranges if not any(map(each.has, numbers))), None)
    if never is not None:
        numbers_are = f"{asked} answers {type.allowed()}"
        raise RecipeError(f"choose has a way '{never}' that no number takes, as {numbers_are}; leave it out")
    return ranges


def _range(asked: str, type: FactType, key: Value) -> Range:
    found = comparison(key) if isinstance(key, str) else None
    if found is not None:
        return found
    if not isinstance(key, int | float) or not type.takes(key):
        raise RecipeError(
            f"choose has a way for {quoted(key)}, and {asked} answers {type.allowed()}; "
            f"write {FORMS}, or '{OTHERWISE}'"
        )
    return exactly(key)


def _check(asked: str, number: float, those: list[Range], *, is_covered: bool) -> None:
    """RecipeError where a number has two ways, or none."""
    if len(those) > 1:
        raise RecipeError(
            f"choose has two ways for {spelled(number)}, '{those[0]}' and '{those[1]}'; "
            "write ranges that do not overlap"
        )
    if not those and not is_covered:
        raise RecipeError(
            f"choose has no way for {spelled(number)}, which {asked} may answer; "
            f"write a range that has it, or a way '{OTHERWISE}'"
        )
