"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from arboleda.drivers import HEALTH
from arboleda_drivers.connections.limits import within


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the driver `dobot`: address of the controller, speed of the arm, its tool output.

    Speed and acceleration are percent of the values set in the controller.
    """

    host: str
    port: int = 29999
    feedback_port: int = 30004
    speed_percent: int | None = None
    acceleration_percent: int | None = None
    tool_output: int | None = 1
    request_control: bool = True
    reported_facts: ClassVar[tuple[str, ...]] = (HEALTH,)
    home_clears_faults: ClassVar[bool] = True  # homing clears alarms, powers the arm and enables it

    def __post_init__(self) -> None:
        within("port", self.port, 1, 65535)
        within("feedback_port", self.feedback_port, 1, 65535)
        within("speed_percent", self.speed_percent, 1, 100)
        within("acceleration_percent", self.acceleration_percent, 1, 100)
        within("tool_output", self.tool_output, 1, 4)

    @property
    def model_speed_share(self) -> float:
        """The share of the model's speed: no move takes longer than by the slower of both percentages."""
        return min(self.speed_percent or 100, self.acceleration_percent or 100) / 100

    def joint_move(self, q: tuple[float, ...]) -> str:
        """The line that moves the joints to `q`, rad."""
        joints = ",".join(f"{math.degrees(each):.4f}" for each in q)
        ratios = {"a": self.acceleration_percent, "v": self.speed_percent}
        options = "".join(f",{name}={ratio}" for name, ratio in ratios.items() if ratio is not None)
        return f"MovJ(joint={{{joints}}}{options})"
