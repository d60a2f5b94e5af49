"""Answers of a plant, a type each: the client in Python returns them, and the API is described by them.

Beside the type of a field, in `Annotated`, a string says what the field is, and an enumeration has its words:
the field stays a text, as a newer plant may have more of them. Two fields whose words no version adds to are
`Literal`.

The types stand in the modules of this package, those of a package's routes with that. Their names are found
here as well, with a warning, for one minor version.
"""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from typing import Any
from warnings import warn

FAMILIES = (
    *(f"{__name__}.{each}" for each in ("tasks", "plant", "offers", "rows")),
    *(f"arboleda_make.answers.{each}" for each in ("drafts", "versions", "trees", "proposals")),
    *("arboleda_proofs.answers", "arboleda_fleet.oee.answers"),
)


def __getattr__(name: str) -> Any:
    for family in () if name.startswith("__") else FAMILIES:
        with suppress(ModuleNotFoundError):  # of a package that is not installed
            if getattr(vars(import_module(family)).get(name), "__module__", "") == family:
                warn(f"use `from {family} import {name}`", DeprecationWarning, stacklevel=2)
                return getattr(import_module(family), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
