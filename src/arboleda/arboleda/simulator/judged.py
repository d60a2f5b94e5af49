"""By which invariants a plant is judged."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from .general import GENERAL, is_general
from .invariants import INVARIANTS, Invariant


def every() -> tuple[Invariant, ...]:
    """All that some plant is judged by."""
    return (*INVARIANTS, *GENERAL)


def judged_by(model: PlantModel) -> tuple[Invariant, ...]:
    """All of storage where that is all that the plant has, else those of any plant."""
    return GENERAL if is_general(model) else INVARIANTS
