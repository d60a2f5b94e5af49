"""Testing of plants: the `sim` of the pytest plugin, the whole chain under time that is moved by hand.

Each name here is imported when it is first used, as pytest loads this package in every run of its plugin.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import strategies
    from .sim import Sim
    from .witness import Witness
    from .words import Misuse

__all__ = ["Misuse", "Sim", "Witness", "strategies"]

HOMES = {"Misuse": "words", "Sim": "sim", "Witness": "witness"}
RUNNER, NOTEBOOK = "arboleda.testing", "arboleda_class.notebook"
MOVED = {  # there; from here with a warning, for one minor version
    **dict.fromkeys(("Rig", "faults", "shipped", "slowed"), RUNNER),
    **dict.fromkeys(("Drawing", "World"), NOTEBOOK),
}


def __getattr__(name: str) -> Any:
    if name in MOVED:
        from arboleda.host.packages import moved
        from arboleda.model.packages import CLASS

        return moved(name, name, MOVED[name], CLASS)
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(f"{__name__}.{HOMES.get(name, name)}")
    return getattr(module, name) if name in HOMES else module
