"""Client of a plant in Python, over its HTTP API: `from arboleda.client import Plant`. It needs httpx, and
neither ROS 2, MQTT nor what the page is made with. Packages add methods to a plant by a class of `Routes`."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from arboleda.model.packages import MAKE

from .answers.plant import Cell, Robot, Snapshot, Teaching
from .answers.rows import Rows
from .answers.tasks import KeptTask, Task
from .errors import (
    Conflict,
    Forbidden,
    Later,
    LibraryMissing,
    MethodMissing,
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
    from .calls import Awaiting, Blocking, Route, Routes, flow, read_answer, route
    from .line import Call, Line
    from .methods import new_id
    from .plant import AsyncPlant, Plant

__all__ = [
    "AsyncPlant",
    "Awaiting",
    "Blocking",
    "Call",
    "Cell",
    "Conflict",
    "Forbidden",
    "KeptTask",
    "Later",
    "LibraryMissing",
    "Line",
    "MethodMissing",
    "NoAnswer",
    "NotFound",
    "OtherPlant",
    "Plant",
    "PlantError",
    "Refusal",
    "Robot",
    "Route",
    "Routes",
    "Rows",
    "Snapshot",
    "StillRunning",
    "Task",
    "Teaching",
    "Unauthorized",
    "WrongRequest",
    "flow",
    "new_id",
    "read_answer",
    "route",
]
HOMES = {
    "calls": ("Awaiting", "Blocking", "Route", "Routes", "flow", "read_answer", "route"),
    "line": ("Call", "Line"),
    "methods": ("new_id",),
    "plant": ("AsyncPlant", "Plant"),
}
"""The modules that load once somebody asks for one of their names."""


def __getattr__(name: str) -> Any:
    """Load the methods of plants once somebody asks one: who only uses the answers' types does not."""
    if name in ("AsyncDraft", "Draft"):
        from arboleda.host.packages import moved  # slow to load, and only needed here

        return moved(name, f"{__name__}.{name}", "arboleda_make.client", MAKE)
    for home, names in HOMES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{home}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
