"""What this package adds to the client of a plant: methods of each `arboleda.client.Plant`, and the same with
types, `Make(plant)`."""

from __future__ import annotations

from .draft import AsyncDraft, Draft
from .methods import AsyncMake, Make

__all__ = ["AsyncDraft", "AsyncMake", "Draft", "Make"]
