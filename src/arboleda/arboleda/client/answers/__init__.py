"""Answers of a plant, a type each: the client in Python returns them, and the API is described by them.

Beside the type of a field, in `Annotated`, a string says what the field is, and an enumeration has its words:
the field stays a text, as a newer plant may have more of them. Two fields whose words no version adds to are
`Literal`.

The types stand in the modules of this package. Their names are found here as well, with a warning, for one
minor version.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any
from warnings import warn

FAMILIES = ("tasks", "plant", "offers", "reports", "drafts", "versions", "trees", "proposals", "rows")


def __getattr__(name: str) -> Any:
    families = () if name.startswith("__") else FAMILIES
    for module in (import_module(f"{__name__}.{family}") for family in families):
        if getattr(vars(module).get(name), "__module__", "") == module.__name__:
            warn(f"use `from {module.__name__} import {name}`", DeprecationWarning, stacklevel=2)
            return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
