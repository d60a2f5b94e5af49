"""A gantry of three axes, and a round of its spots."""

from dataclasses import dataclass

from arboleda.kinds import Axes, Axis, moving_kind
from arboleda.recipes import Target, recipe, work


@dataclass(frozen=True, kw_only=True)
class Gantry:
    """What the plant file may say of a gantry: its fastest move, and in which corner it is homed."""

    mm_s: float = 60.0
    far: bool = True


@moving_kind("gantry")
def gantry(settings: Gantry) -> Axes:
    """Goes over a bench; one that counts from its home in the far corner has places below 0."""

    def axis(name, length, speed):
        lower, upper = (-length, 5) if settings.far else (-5, length)
        return Axis(name, unit="mm", lower=lower, upper=upper, speed=speed, step=0.02)

    fast = settings.mm_s
    return Axes(axis("x", 300, fast), axis("y", 300, fast), axis("z", 60, fast / 2))


@recipe("visit")
def visit(cell, first=Target("spots"), second=Target("spots")):
    """Go to one spot, then to another one, and home."""
    machine = cell.device("gantry")
    return work(machine.go(first), machine.go(second), machine.go("home"))
