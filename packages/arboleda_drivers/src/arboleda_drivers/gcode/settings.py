"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

from arboleda.drivers import HEALTH, DriverError, Evidence, Jointed, Robot
from arboleda_drivers.connections.stream import StreamAddress

LETTERS = ("X", "Y", "Z", "A", "B", "C")  # in the order of a position
MM = 1000.0


@dataclass(frozen=True, kw_only=True)
class Settings(StreamAddress):
    """Settings of the driver `gcode`: the line, and the letter of each axis with its zero.

    `zeros_mm` are the positions of the machine at which the axes of the model are at 0; `stop_keeps_place`
    declares that a machine with Marlin loses no step where it stops without braking. Moonraker is at a host.
    """

    baud: int = 115200
    dialect: Literal["grbl", "marlin", "moonraker"] = "grbl"
    axes: tuple[Literal["X", "Y", "Z"], ...] = ("X", "Y", "Z")
    zeros_mm: tuple[float, ...] = ()
    homing: bool = True
    stop_keeps_place: bool = False
    speed_percent: int = 50
    poll_s: float = 0.1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.axes or len(set(self.axes)) < len(self.axes):
            raise DriverError("axes needs a letter for each axis, each once")
        if self.zeros_mm and len(self.zeros_mm) != len(self.axes):
            raise DriverError(f"zeros_mm has {len(self.zeros_mm)} numbers for {len(self.axes)} axes")
        if not 1 <= self.speed_percent <= 100:
            raise DriverError(f"speed_percent is {self.speed_percent}; allowed: 1 to 100")
        if not 0.05 <= self.poll_s <= 0.5:
            raise DriverError(f"poll_s is {self.poll_s:g}; allowed: 0.05 to 0.5")
        if self.stop_keeps_place and self.dialect != "marlin":
            raise DriverError(
                "stop_keeps_place is for dialect: marlin; others keep their place by themselves"
            )
        if self.dialect == "moonraker" and self.serial:
            raise DriverError("dialect: moonraker needs host and port, not serial; its port is 7125")
        if self.dialect == "moonraker" and not self.homing:
            raise DriverError("homing: false is not for moonraker; Klipper moves only what was homed")

    @property
    def reported_facts(self) -> tuple[str, ...]:
        """The facts that the machine tells; only GRBL knows of a door."""
        return (HEALTH, "door", "mode") if self.dialect == "grbl" else (HEALTH, "mode")

    @property
    def home_clears_faults(self) -> bool:
        """True for GRBL, where homing begins with a reset if that is needed; others need one by hand."""
        return self.dialect == "grbl"

    @property
    def home_moves(self) -> bool:
        """True where the machine homes by its switches."""
        return self.homing

    @property
    def home_is_claim(self) -> bool:
        """True for a machine without switches: only a person knows that it stands at its zero."""
        return not self.homing

    @property
    def model_speed_share(self) -> float:
        """The share of the model's speed at which the machine is moved."""
        return self.speed_percent / 100

    @property
    def zeros(self) -> tuple[float, ...]:
        """The machine's position at the model's zero, mm."""
        return self.zeros_mm or (0.0,) * len(self.axes)

    def joints(self, position: tuple[float, ...]) -> tuple[float, ...]:
        """The axes of the model, m, at a position of the machine, mm."""
        rows = zip(self.axes, self.zeros, strict=True)
        return tuple((position[LETTERS.index(letter)] - zero) / MM for letter, zero in rows)

    def words(self, q: tuple[float, ...]) -> str:
        """The words of G-code for the axes at `q`, m."""
        rows = zip(self.axes, q, self.zeros, strict=True)
        return "".join(f"{letter}{at * MM + zero:.3f}" for letter, at, zero in rows)

    @property
    def words_of_zero(self) -> str:
        """The words of G-code for the place where the machine counts 0."""
        return " ".join(f"{letter}0" for letter in self.axes)

    def place(self, q: tuple[float, ...], before: tuple[float, ...]) -> tuple[float, ...]:
        """The place of the machine, mm, with its axes at `q`, m; others stay where they were before."""
        place = list(before)
        for letter, at, zero in zip(self.axes, q, self.zeros, strict=True):
            place[LETTERS.index(letter)] = round(at * MM + zero, 4)
        return tuple(place)

    def feed(self, robot: Jointed, start: Sequence[float], goal: Sequence[float]) -> float:
        """The speed of a straight move, mm/min, at which no axis is faster than it may be."""
        ways = [abs(there - here) for here, there in zip(start, goal, strict=True)]
        rows = zip(ways, robot.joints, strict=True)
        time_s = max(way / (joint.speed * self.model_speed_share) for way, joint in rows)
        return max(math.hypot(*ways) * MM / time_s * 60 if time_s > 0 else 60.0, 1.0)

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Jointed):
            yield (), f"{device.name} has no axes; this driver moves robots of axes"
            return
        if len(self.axes) != len(device.joints):
            yield (
                ("axes",),
                f"there are {len(self.axes)} letters for the {len(device.joints)} axes of {device.name}",
            )
        for joint in device.joints:
            if joint.unit != "m":
                yield ("axes",), f"{joint.name} turns; this driver moves axes that slide"
        if device.home_at_start and not self.homing:
            yield (
                ("homing",),
                f"homing: false contradicts home_at_start: true of {device.name}: without switches only a "
                "person knows where it stands; keep one of them",
            )
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; this driver proves ids"
