"""Numbers with the things that they count, as people write them."""

from __future__ import annotations


def counted(number: int, thing: str) -> str:
    """`1 seed`, `1,200 seeds`."""
    return f"{number:,} {thing}{'' if number == 1 else 's'}"
