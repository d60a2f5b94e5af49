"""Routes that the parts of a plant bring."""

from __future__ import annotations

from collections.abc import Callable
from importlib.metadata import EntryPoint
from typing import Any, NamedTuple

from arboleda.host.pieces import Piece


class PartRoute(NamedTuple):
    """Routes of a part: `make` makes an APIRouter."""

    point: EntryPoint
    part: Piece
    make: Callable[[], Any]


class PartRoutes(list[PartRoute]):
    """PartRoutes: what makes the routes of each part."""
