"""Facts: named values that a device reports beside its state and its position."""

from __future__ import annotations

Value = bool | int | float | str
"""Value of a fact: `"open"` of a door, True of a clamp, 1001 of a program."""
Facts = tuple[tuple[str, Value], ...]
"""Facts by name."""
HEALTH = "health"
"""The fact, a word, by which a robot's hardware reports what keeps it from moving; WELL for nothing."""
WELL = "ok"
"""The value of HEALTH of a robot that nothing keeps from moving."""


def shown(value: Value) -> str:
    """A value as a plant file has it.

    >>> shown(True), shown("open"), shown(0.5)
    ('true', 'open', '0.5')
    """
    return str(value).lower() if isinstance(value, bool) else str(value)
