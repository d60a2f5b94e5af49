"""Former place of `arboleda_proofs.testing`: its names, with a warning, for one minor version."""

from __future__ import annotations

from importlib import import_module
from typing import Any
from warnings import warn

from arboleda.model.packages import MISSING, PROOFS
from arboleda.model.sentence import OWN

HERE = "arboleda_proofs.testing"


def __getattr__(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    warn(f"use `from {HERE} import {name}`", DeprecationWarning, stacklevel=2)
    try:
        return getattr(import_module(HERE), name)
    except ModuleNotFoundError as error:
        if error.name != HERE.partition(".")[0]:
            raise
        raise ImportError(str(MISSING(what=OWN(text=__name__), package=PROOFS))) from error
