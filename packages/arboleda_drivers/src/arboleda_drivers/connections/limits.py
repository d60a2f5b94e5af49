"""Limits of the numbers in a driver's settings."""

from __future__ import annotations


def within(name: str, value: int | None, lowest: int, highest: int) -> None:
    """Raises ValueError, which names the setting, for a value beyond its limits; None is none."""
    if value is not None and not lowest <= value <= highest:
        raise ValueError(f"{name} is {value}; allowed: {lowest} to {highest}")
