"""By which invariants a plant is judged."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from .general import GENERAL, is_general
from .invariants import INVARIANTS, Invariant
from .invariants.hosts import HOSTS


def every() -> tuple[Invariant, ...]:
    """All that some plant is judged by."""
    return (*INVARIANTS, *GENERAL, *HOSTS)


def judged_by(model: PlantModel, *, standby: bool = False) -> tuple[Invariant, ...]:
    """All of storage where that is all that the plant has, else those of any plant; of two hosts, too."""
    of_plant = GENERAL if is_general(model) else INVARIANTS
    return (*of_plant, *HOSTS) if standby else of_plant
