"""Virtual robots that are faster or slower than the real ones."""

from __future__ import annotations

from dataclasses import replace

from arboleda.model.errors import StartError
from arboleda.model.plant_model import PlantModel


def check_rate(rate: float) -> float:
    """The rate itself; StartError if it makes no sense."""
    if not 0.1 <= rate <= 100:
        raise StartError(f"{rate:g} is not a rate; allowed: 0.1 to 100")
    return rate


def at_rate(model: PlantModel, rate: float) -> PlantModel:
    """The same plant, its robots `rate` times as fast; slow ones also get more time to come to rest."""
    check_rate(rate)
    stop_timeout_s = model.timing.stop_timeout_s / min(rate, 1.0)
    return replace(
        model,
        cells=tuple(cell.with_robots(lambda robot: robot.at_rate(rate)) for cell in model.cells),
        timing=replace(model.timing, stop_timeout_s=stop_timeout_s),
    )
