"""Former place of `arboleda_proofs.testing`: its names, with a warning, for one minor version."""

from __future__ import annotations

from typing import Any

from arboleda.host.packages import moved
from arboleda.model.packages import PROOFS


def __getattr__(name: str) -> Any:
    if name.startswith("__"):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return moved(name, __name__, "arboleda_proofs.testing", PROOFS)
