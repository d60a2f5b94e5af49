"""Methods of this package for the client of a plant: of each `Plant`, and with types, `Make(plant)`."""

from __future__ import annotations

from .draft import AsyncDraft, Draft
from .methods import AsyncMake, Make

__all__ = ["AsyncDraft", "AsyncMake", "Draft", "Make"]
