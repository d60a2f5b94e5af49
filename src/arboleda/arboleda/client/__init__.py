"""Client of a plant in Python, over its HTTP API: `from arboleda.client import Plant`. It needs httpx, and
neither ROS 2, MQTT nor what the page is made with."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .answers.plant import Snapshot
from .answers.rows import Rows
from .answers.tasks import KeptTask, Task
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

if TYPE_CHECKING:
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


def __getattr__(name: str) -> Any:
    """Load the methods of plants once somebody asks one: who only uses the answers' types does not."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.plant"), name)
