"""Choice of the invariants by which a plant is judged."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from .general import GENERAL, is_general
from .invariants import Invariant
from .invariants.advice import ADVICE
from .invariants.beliefs import BELIEFS
from .invariants.bridge import BRIDGE
from .invariants.choices import CHOICES
from .invariants.commands import COMMANDS
from .invariants.hosts import HOSTS
from .invariants.liveness import LIVENESS
from .invariants.memory import MEMORY
from .invariants.memory_bounds import BOOKS
from .invariants.motion import MOTION
from .invariants.oee import OEE
from .invariants.proofs import PROOFS
from .invariants.screens import SCREENS
from .invariants.starts import STARTS
from .invariants.stop import STOP
from .invariants.tasks import TASKS
from .invariants.verbs import VERBS
from .invariants.wire import WIRE
from .invariants.zones import ZONES
from .storage.grip import GRIP
from .storage.recipe_order import WORK
from .storage.texts import TEXTS

INVARIANTS: tuple[Invariant, ...] = (
    *ZONES,
    *MOTION,
    *GRIP,
    *STOP,
    *COMMANDS,
    *PROOFS,
    *WIRE,
    *BRIDGE,
    *BELIEFS,
    *TASKS,
    *CHOICES,
    *TEXTS,
    *WORK,
    *VERBS,
    *ADVICE,
    *MEMORY,
    *LIVENESS,
    *BOOKS,
    *OEE,
    *SCREENS,
    *STARTS,
)
"""What must hold of plants whose cells only store."""


def every() -> tuple[Invariant, ...]:
    """Every invariant by which some plant is judged."""
    return (*INVARIANTS, *GENERAL, *HOSTS)


def judged_by(model: PlantModel, *, standby: bool = False) -> tuple[Invariant, ...]:
    """The invariants for a plant: of storage or general, and those of two hosts where there are two."""
    of_plant = GENERAL if is_general(model) else INVARIANTS
    return (*of_plant, *HOSTS) if standby else of_plant
