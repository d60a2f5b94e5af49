"""Authoring of kinds of robots that move: a function of settings that returns axes, or a drive over a grid.

@dataclass(frozen=True, kw_only=True)
class Turntable:
    deg_s: float = 45.0

@moving_kind("turntable")
def turntable(settings: Turntable) -> Axes:
    return Axes(Axis("table", lower=-180, upper=180, speed=settings.deg_s))

The fields of the settings are the keys that the plant file takes for a robot of this kind, beside those of
every robot.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from arboleda.model.outside import quoted
from arboleda.model.plant_model import Robot

from .authoring import settings_of
from .floor import Placement
from .joints import Joint, Jointed
from .mobile import Grid, Mobile
from .verbs import KindError

SI = {"deg": math.radians(1.0), "mm": 0.001}
PINION_M = math.degrees(0.001)  # a pinion that moves its rack by 1 mm per degree


@dataclass(frozen=True)
class Axis:
    """Axis of a robot, in degrees or millimetres and seconds; raises KindError for one that cannot be.

    `lower` and `upper` are its limits, with 0, where it is homed, between them. `acceleration` is by default
    four times `speed`; `step` is one motor step.
    """

    name: str
    unit: Literal["deg", "mm"] = "deg"
    lower: float = 0.0
    upper: float = 0.0
    speed: float = 0.0
    acceleration: float | None = None
    step: float = 0.01

    def __post_init__(self) -> None:
        if self.unit not in SI:
            raise KindError(f"the unit of axis {self.name} must be deg or mm, is {quoted(self.unit)}")
        if not self.name.isidentifier():
            raise KindError(f"an axis must have a name of letters, digits and _, has {quoted(self.name)}")
        if not (-math.inf < self.lower <= 0 <= self.upper < math.inf and self.lower < self.upper):
            limits = f"from {self.lower:g} to {self.upper:g}"
            raise KindError(f"axis {self.name} must go from below to above, with 0 inside; it goes {limits}")
        for key in ("speed", "acceleration", "step"):
            value = getattr(self, key)
            if value is not None and not 0 < value < math.inf:
                raise KindError(f"{key} of axis {self.name} must be more than 0, is {value:g}")

    @property
    def joint(self) -> Joint:
        """The axis in SI units."""
        si = SI[self.unit]
        acceleration = 4 * self.speed if self.acceleration is None else self.acceleration
        return Joint(
            name=self.name,
            lower=self.lower * si,
            upper=self.upper * si,
            speed=self.speed * si,
            acceleration=acceleration * si,
            step=self.step * si,
            pinion_radius_m=PINION_M if self.unit == "mm" else None,
            up=0,
        )


class Axes:
    """One to nine axes that move together; a target of such a robot has `deg` and `mm`, as an arm's has.

    Raises KindError for no axis, more than nine, or two of one name.
    """

    def __init__(self, *axes: Axis) -> None:
        if not 1 <= len(axes) <= 9:
            raise KindError(f"a robot has 1 to 9 axes, not {len(axes)}")
        if len({axis.name for axis in axes}) < len(axes):
            raise KindError(f"two axes have one name: {', '.join(axis.name for axis in axes)}")
        self.axes = axes

    def robot(self, kind: str, named: Mapping[str, Any]) -> Robot:
        """The robot of this kind that has these names, link and evidence."""
        return Jointed(kind_name=kind, joints=tuple(axis.joint for axis in self.axes), **named)


@dataclass(frozen=True, kw_only=True)
class GridDrive:
    """Drive over the nodes of a grid, numbered row by row from 0; a target of such a robot has its `node`.

    Raises KindError for fewer than two nodes, or a pitch or speed that is not more than 0.
    """

    rows: int
    columns: int
    pitch_mm: float
    mm_s: float

    def __post_init__(self) -> None:
        if self.rows < 1 or self.columns < 1 or self.rows * self.columns < 2:
            raise KindError(f"a grid has at least 2 nodes, not {self.rows} rows of {self.columns}")
        for key in ("pitch_mm", "mm_s"):
            if not 0 < getattr(self, key) < math.inf:
                raise KindError(f"{key} must be more than 0, is {getattr(self, key):g}")

    def robot(self, kind: str, named: Mapping[str, Any]) -> Robot:
        """The robot of this kind that has these names, link and evidence."""
        grid = Grid(
            origin=Placement(x=0.0, y=0.0, is_declared=False),
            pitch=self.pitch_mm / 1000,
            rows=self.rows,
            columns=self.columns,
        )
        return Mobile(kind_name=kind, grid=grid, speed=self.mm_s / 1000, **named)


@dataclass(frozen=True, kw_only=True)
class MovingKind:
    """Kind as `@moving_kind` makes it: its name, and the function that returns how its robots move.

    `settings` is the frozen dataclass that the function takes, None if it takes nothing; `about` is the first
    line of its docstring.
    """

    name: str
    function: Callable[..., Axes | GridDrive]
    settings: type[Any] | None = None
    about: str = ""

    def robot(self, settings: object | None, named: Mapping[str, Any]) -> Robot:
        """The robot with these settings (None for a function that takes nothing), names, link and evidence.

        Raises KindError if the function returns neither Axes nor a GridDrive.
        """
        made = self.function() if self.settings is None else self.function(settings)
        if not isinstance(made, Axes | GridDrive):
            what = f"{self.name} returns {quoted(made)}"
            raise KindError(f"{what}; a kind that moves returns Axes(...) or GridDrive(...)")
        return made.robot(self.name, named)


def moving_kind(name: str) -> Callable[[Callable[..., Axes | GridDrive]], MovingKind]:
    """Decorator that makes a kind of robots, called `name` in plant files, of a function that returns Axes or
    a GridDrive.

    The function takes its settings, an instance of a frozen dataclass to which it is annotated, or nothing.
    The first line of its docstring describes the kind to users. Raises KindError for another signature.
    """

    def made(function: Callable[..., Axes | GridDrive]) -> MovingKind:
        if not inspect.isfunction(function):
            raise KindError(f"{name}: a kind is a function, and {quoted(function)} is none")
        about = (inspect.getdoc(function) or "").partition("\n")[0]
        return MovingKind(name=name, function=function, settings=settings_of(name, function), about=about)

    return made
