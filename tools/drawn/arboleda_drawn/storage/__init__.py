"""Drawn plants with cells of an arm, a mobile robot and a rack, as plain data."""

from __future__ import annotations

from .draw import NOT_DRAWN, draw
from .reductions import smaller

__all__ = ["NOT_DRAWN", "draw", "smaller"]
