"""Check of a plant whose file is good: all that it is warned of."""

from __future__ import annotations

from arboleda.model.plant_model import PlantModel

from . import (
    advance_check,
    grid_check,
    layout_check,
    loader,
    meeting_points,
    need_check,
    passed_over,
    place_check,
    unused_steps,
)
from .problems import told_once

CHECKS = (
    loader,
    layout_check,
    meeting_points,
    grid_check,
    place_check,
    need_check,
    unused_steps,
    advance_check,
    passed_over,
)


def warnings(plant: PlantModel) -> tuple[str, ...]:
    """The warnings of all checks, one sentence each, and one for all cells of which it is the same."""
    found = [sentence for check in CHECKS for sentence in check.warnings(plant)]
    return told_once(found, [cell.name for cell in plant.cells])
