"""A gantry of three axes, and a round of its spots."""

from dataclasses import dataclass

from arboleda.kinds import Axes, Axis, moving_kind
from arboleda.recipes import Target, recipe, work


@dataclass(frozen=True, kw_only=True)
class Gantry:
    """What the plant file may say of a gantry: its fastest move."""

    mm_s: float = 60.0


@moving_kind("gantry")
def gantry(settings: Gantry) -> Axes:
    """Goes over a bench; GRBL counts from its home in the far corner, so its places are below 0."""
    x = Axis("x", unit="mm", lower=-300, upper=5, speed=settings.mm_s, step=0.02)
    y = Axis("y", unit="mm", lower=-300, upper=5, speed=settings.mm_s, step=0.02)
    z = Axis("z", unit="mm", lower=-60, upper=5, speed=settings.mm_s / 2, step=0.02)
    return Axes(x, y, z)


@recipe("visit")
def visit(cell, first=Target("spots"), second=Target("spots")):
    """Go to one spot, then to another one, and home."""
    machine = cell.device("gantry")
    return work(machine.go(first), machine.go(second), machine.go("home"))
