"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from arboleda.drivers import HEALTH
from arboleda_drivers.connections.limits import within

from .programs import OUTPUT_COUNT

SLIDER = "speed_slider_percent"
"""The fact of the speed slider at the pendant."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the driver `ur`: address of the controller, speed of the arm, its output and registers.

    Speed and acceleration are percent of the arm's model. `output` is counted as RTDE does: 0 to 7 the
    standard ones, 8 to 15 the configurable ones, 16 and 17 those at the tool.
    """

    host: str
    port: int = 29999
    rtde_port: int = 30004
    script_port: int = 30001
    speed_percent: int = 100
    acceleration_percent: int = 100
    stop_deg_s2: float = 230.0
    output: int | None = 16
    registers_from: int = 24
    reported_facts: ClassVar[tuple[str, ...]] = (HEALTH, SLIDER)
    home_clears_faults: ClassVar[bool] = (
        True  # homing unlocks a protective stop, powers the arm, frees its brakes
    )

    def __post_init__(self) -> None:
        for name in ("port", "rtde_port", "script_port"):
            within(name, getattr(self, name), 1, 65535)
        if len({self.port, self.rtde_port, self.script_port}) < 3:
            raise ValueError("port, rtde_port and script_port must differ")
        within("speed_percent", self.speed_percent, 1, 100)
        within("acceleration_percent", self.acceleration_percent, 1, 100)
        within("output", self.output, 0, OUTPUT_COUNT - 1)
        within("registers_from", self.registers_from, 0, 46)
        if not 1 <= self.stop_deg_s2 <= 2000:
            raise ValueError(f"stop_deg_s2 is {self.stop_deg_s2:g}; allowed: 1 to 2000")

    @property
    def model_speed_share(self) -> float:
        """The share of the model's speed: no move takes longer than by the slower of both percentages."""
        return min(self.speed_percent, self.acceleration_percent) / 100

    @property
    def stop_rad_s2(self) -> float:
        return math.radians(self.stop_deg_s2)
