"""Testing of plants: the `sim` of the pytest plugin, the whole chain under time that is moved by hand, and a
world for notebooks.

Each name here is imported when it is first used, as pytest loads this package in every run of its plugin.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import faults, strategies
    from .drawn import Drawing
    from .plants import shipped, slowed
    from .rig import Rig
    from .sim import Sim
    from .witness import Witness
    from .words import Misuse
    from .world import World

__all__ = ["Drawing", "Misuse", "Rig", "Sim", "Witness", "World", "faults", "shipped", "slowed", "strategies"]

HOMES = {
    "Drawing": "drawn",
    "Misuse": "words",
    "Rig": "rig",
    "Sim": "sim",
    "Witness": "witness",
    "World": "world",
    "shipped": "plants",
    "slowed": "plants",
}


def __getattr__(name: str) -> Any:
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{HOMES.get(name, name)}")
    return getattr(module, name) if name in HOMES else module
