"""Values as the firmware's core has them: numbers, for words the place in their list."""

from __future__ import annotations

from arboleda.kinds.declared import FactType
from arboleda.model.facts import Value, shown

DECIMALS = 4  # of a number that a board says


def encoded(type: FactType, value: Value) -> float:
    """A value of a fact or of a parameter."""
    if type.words:
        return float(type.words.index(value))
    return float(value) if isinstance(value, bool | int | float) else 0.0


def named(type: FactType) -> dict[str, Value]:
    """The values that a fact can have, by how a person writes them; none for one that is measured."""
    values: tuple[Value, ...] = (True, False) if type.type is bool else type.words
    return {shown(value): value for value in values}


def sayable(type: FactType) -> bool:
    """Whether a board of few decimals can say every value that is listed."""
    return all(not isinstance(word, float) or round(word, DECIMALS) == word for word in type.words)
