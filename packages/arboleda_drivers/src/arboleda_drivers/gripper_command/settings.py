"""The keys of the driver in a plant file."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from arboleda.drivers import Device, Evidence, Robot

FACTS: dict[str, tuple[type, ...]] = {"gripped": (bool,), "width_mm": (int, float), "force_n": (int, float)}
VALUES = ("width_mm", "force_n")
KNOWN = "gripped: bool, width_mm: number, force_n: number"


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the driver `gripper_command`: the gripper's action and joint, and the opening of its
    fingers.

    `open` is the position of its joint (m or rad) where the fingers are `width_mm` apart, `closed` where
    they touch. A part is believed only from `narrowest_mm` to `widest_mm`. `lan` lets the driver reach
    other machines.
    """

    action: str = "gripper_controller/gripper_cmd"
    type: Literal["single", "parallel"] = "single"
    joint_states: str = "joint_states"
    joint: str = "finger_joint"
    open: float
    closed: float = 0.0
    width_mm: float = 85.0
    tolerance_mm: float = 1.0
    narrowest_mm: float = 0.0
    widest_mm: float | None = None
    lan: bool = False

    def __post_init__(self) -> None:
        if self.open == self.closed:
            raise ValueError(f"open and closed are both {self.open:g}; they are two positions of the joint")
        for name in ("width_mm", "tolerance_mm"):
            if not 0 < getattr(self, name) <= 1000:
                raise ValueError(f"{name} is {getattr(self, name):g}; allowed: more than 0, to 1000")
        if not 0 <= self.narrowest_mm < self.widest:
            raise ValueError(
                f"narrowest_mm is {self.narrowest_mm:g}; allowed: 0 to less than {self.widest:g}"
            )
        for name in ("action", "joint_states", "joint"):
            if not getattr(self, name):
                raise ValueError(f"{name} is empty; it is a name of ROS 2")

    @property
    def widest(self) -> float:
        return self.width_mm if self.widest_mm is None else self.widest_mm

    @property
    def units_per_mm(self) -> float:
        """Travel of the joint (m or rad) per mm of opening."""
        return (self.open - self.closed) / self.width_mm

    def position(self, width_mm: float) -> float:
        return self.closed + width_mm * self.units_per_mm

    def width(self, position: float) -> float:
        return (position - self.closed) / self.units_per_mm

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; an action proves ids"
        if not isinstance(device, Device):
            yield (), f"{device.name} is of no declared kind; a gripper is, as kind: gripper"
            return
        unsaid = [name for name, type in device.kind.facts.items() if type.type not in FACTS.get(name, ())]
        if unsaid:
            yield (), f"a gripper says nothing of {', '.join(unsaid)}; it has {KNOWN}"
        for verb in device.kind.verbs.values():
            strange = [name for name, _ in verb.parameters if name not in VALUES]
            if strange:
                known = ", ".join(VALUES)
                yield (), f"{verb.name} has {', '.join(strange)}; a gripper is told {known}"
