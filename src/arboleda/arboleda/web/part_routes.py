"""Routes that the parts of a plant bring."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import EntryPoint
from typing import Any


class PartRoutes(list[tuple[EntryPoint, Callable[[], Any]]]):
    """PartRoutes: the functions that make an APIRouter, or None, each with the entry point of its part."""
