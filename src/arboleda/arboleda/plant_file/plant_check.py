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
    """The warnings of all checks, one sentence each."""
    return tuple(sentence for check in CHECKS for sentence in check.warnings(plant))
