"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from dataclasses import dataclass


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

    def __post_init__(self) -> None:
        _within("port", self.port, 1, 65535)
        _within("feedback_port", self.feedback_port, 1, 65535)
        _within("speed_percent", self.speed_percent, 1, 100)
        _within("acceleration_percent", self.acceleration_percent, 1, 100)
        _within("tool_output", self.tool_output, 1, 4)

    def joint_move(self, q: tuple[float, ...]) -> str:
        """The line that moves the joints to `q`, rad."""
        joints = ",".join(f"{math.degrees(each):.4f}" for each in q)
        ratios = {"a": self.acceleration_percent, "v": self.speed_percent}
        asked = "".join(f",{name}={ratio}" for name, ratio in ratios.items() if ratio is not None)
        return f"MovJ(joint={{{joints}}}{asked})"


def _within(name: str, value: int | None, lowest: int, highest: int) -> None:
    if value is not None and not lowest <= value <= highest:
        raise ValueError(f"{name} is {value}; allowed: {lowest} to {highest}")
