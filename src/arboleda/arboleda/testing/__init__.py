"""Plants for tests: the shipped one, a rig of a plant, and `plant_with` for parts of packages, a fixture.
Time is moved by hand.

Each name here is imported when it is first used. Names of `arboleda_proofs.testing` lead there, with a
warning, for one minor version.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from arboleda.host.packages import moved
from arboleda.model.packages import PROOFS

if TYPE_CHECKING:
    from arboleda.rig import faults
    from arboleda.rig.rig import Rig

    from .plants import shipped, slowed
    from .storage_layout import Palletizing, StorageLayout
    from .with_parts import PlantWith

__all__ = ["Palletizing", "PlantWith", "Rig", "StorageLayout", "faults", "shipped", "slowed"]

HOMES = {
    "Palletizing": f"{__name__}.storage_layout",
    "PlantWith": f"{__name__}.with_parts",
    "Rig": "arboleda.rig.rig",
    "StorageLayout": f"{__name__}.storage_layout",
    "shipped": f"{__name__}.plants",
    "slowed": f"{__name__}.plants",
}


def __getattr__(name: str) -> Any:
    if name == "faults":
        return import_module("arboleda.rig.faults")
    if name in HOMES:
        return getattr(import_module(HOMES[name]), name)
    if name.startswith("__"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return moved(name, __name__, "arboleda_proofs.testing", PROOFS)
