"""Tasks of a recipe in a cell, by all values of its parameters: all of them, or some of very many."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from .plant_model import Cell
from .recipe import Recipe
from .task import Order

MOST = 200  # combinations of parameters that are tried


def combinations(cell: Cell, recipe: Recipe) -> int:
    """The number of different tasks that a recipe has in a cell."""
    return math.prod(len(each.words(cell)) for each in recipe.parameters)


def orders(cell: Cell, recipe: Recipe) -> Iterator[Order]:
    """Every task of a recipe; of more than MOST, so many of them, with each value if possible."""
    words = [each.words(cell) for each in recipe.parameters]
    total = combinations(cell, recipe)
    for number in range(min(total, MOST)):
        chosen = _sampled(words, number) if total > MOST else _nth(words, number)
        rows = list(zip(recipe.parameters, chosen, strict=True))
        yield Order(
            text=" ".join([cell.name, recipe.name, *chosen]),
            cell=cell.name,
            recipe=recipe.name,
            values={each.name: each.value(cell, word) for each, word in rows},
        )


def _nth(words: Sequence[Sequence[str]], number: int) -> list[str]:
    """The combination of that number; different numbers have different combinations."""
    chosen = []
    for each in words:
        number, index = divmod(number, len(each))
        chosen.append(each[index])
    return chosen


def _sampled(words: Sequence[Sequence[str]], number: int) -> list[str]:
    """The combination of that number among MOST: each parameter goes through all its values.

    The values of one parameter are shifted against those of the next, so that all pairs come together.
    """
    chosen = []
    for column, each in enumerate(words):
        many = len(each)
        index = number * many // MOST if many > MOST else (number + column * (number // many)) % many
        chosen.append(each[index])
    return chosen
