"""Values as the firmware's core has them: numbers, for words the place in their list."""

from __future__ import annotations

from arboleda.drivers import FactType, Value, shown

DECIMALS = 4  # of a number in telemetry


def encoded(type: FactType, value: Value) -> float:
    """The number for a value of a fact or of a parameter."""
    if type.words:
        return float(type.words.index(value))
    return float(value) if isinstance(value, bool | int | float) else 0.0


def named(type: FactType) -> dict[str, Value]:
    """The values of a fact by the words that a person writes; none for a measured one."""
    values: tuple[Value, ...] = (True, False) if type.type is bool else type.words
    return {shown(value): value for value in values}


def sayable(type: FactType) -> bool:
    """True if a board can write every listed value with the few decimals that it has."""
    return all(not isinstance(word, float) or round(word, DECIMALS) == word for word in type.words)
