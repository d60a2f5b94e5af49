"""Client of a plant in Python, over its HTTP API: `from arboleda.client import Plant`. It needs httpx, and
neither ROS 2, MQTT nor what the page is made with."""

from __future__ import annotations

from .answers import KeptTask, Rows, Snapshot, Task
from .errors import (
    Conflict,
    Forbidden,
    Later,
    LibraryMissing,
    NoAnswer,
    NotFound,
    OtherPlant,
    PlantError,
    Refusal,
    StillRunning,
    Unauthorized,
    WrongRequest,
)
from .plant import AsyncDraft, AsyncPlant, Draft, Plant

__all__ = [
    "AsyncDraft",
    "AsyncPlant",
    "Conflict",
    "Draft",
    "Forbidden",
    "KeptTask",
    "Later",
    "LibraryMissing",
    "NoAnswer",
    "NotFound",
    "OtherPlant",
    "Plant",
    "PlantError",
    "Refusal",
    "Rows",
    "Snapshot",
    "StillRunning",
    "Task",
    "Unauthorized",
    "WrongRequest",
]
