"""Virtual robots that are faster or slower than the real ones."""

from __future__ import annotations

from dataclasses import replace

from arboleda.core.errors import StartError
from arboleda.core.model import PlantModel


def check_rate(rate: float) -> float:
    """The rate itself; StartError where it makes no sense."""
    if not 0.1 <= rate <= 100:
        raise StartError(f"{rate:g} is not a rate; allowed: 0.1 to 100")
    return rate


def at_rate(model: PlantModel, rate: float) -> PlantModel:
    """The same plant, its robots `rate` times as fast."""
    check_rate(rate)
    return replace(
        model, cells=tuple(cell.with_robots(lambda robot: robot.at_rate(rate)) for cell in model.cells)
    )
