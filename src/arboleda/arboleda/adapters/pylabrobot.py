"""The name under which files of plants imported `machine` before `arboleda_drivers` was a package of its own.

It goes with the next minor version.
"""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any

NOW = "arboleda_drivers.pylabrobot.adapter"


def __getattr__(name: str) -> Any:
    if name.startswith("__"):  # as `__path__`, for which Python asks before it imports a name
        raise AttributeError(name)
    warnings.warn(f"{__name__} is {NOW} now", DeprecationWarning, stacklevel=2)
    return getattr(import_module(NOW), name)
