"""Choice of the invariants by which a plant is judged."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from .general import GENERAL, is_general
from .invariants import INVARIANTS, Invariant
from .invariants.hosts import HOSTS


def every() -> tuple[Invariant, ...]:
    """Every invariant by which some plant is judged."""
    return (*INVARIANTS, *GENERAL, *HOSTS)


def judged_by(model: PlantModel, *, standby: bool = False) -> tuple[Invariant, ...]:
    """The invariants for a plant: of storage or general, and those of two hosts where there are two."""
    of_plant = GENERAL if is_general(model) else INVARIANTS
    return (*of_plant, *HOSTS) if standby else of_plant
