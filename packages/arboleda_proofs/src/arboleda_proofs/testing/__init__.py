"""Testing of plants: the `sim` of the pytest plugin, the whole chain under time that is moved by hand.

Each name here is imported when it is first used, as pytest loads this package in every run of its plugin.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any
from warnings import warn

if TYPE_CHECKING:
    from . import faults, strategies
    from .plants import shipped, slowed
    from .rig import Rig
    from .sim import Sim
    from .witness import Witness
    from .words import Misuse

__all__ = ["Misuse", "Rig", "Sim", "Witness", "faults", "shipped", "slowed", "strategies"]

HOMES = {
    "Misuse": "words",
    "Rig": "rig",
    "Sim": "sim",
    "Witness": "witness",
    "shipped": "plants",
    "slowed": "plants",
}
NOTEBOOK = "arboleda_class.notebook"
MOVED = ("Drawing", "World")  # there; from here with a warning, for one minor version


def __getattr__(name: str) -> Any:
    if name in MOVED:
        return _moved(name)
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{HOMES.get(name, name)}")
    return getattr(module, name) if name in HOMES else module


def _moved(name: str) -> Any:
    warn(f"use `from {NOTEBOOK} import {name}`", DeprecationWarning, stacklevel=3)
    try:
        return getattr(import_module(NOTEBOOK), name)
    except ModuleNotFoundError as error:
        from arboleda.model.packages import CLASS, MISSING
        from arboleda.model.sentence import OWN

        raise ImportError(str(MISSING(what=OWN(text=name), package=CLASS))) from error
