"""Plant files drawn from a seed, as plain data: what a person could write, odd values included."""

from __future__ import annotations

from .draw import NOT_DRAWN, draw
from .reductions import smaller

__all__ = ["NOT_DRAWN", "draw", "smaller"]
