"""The keys of the driver in a plant file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from arboleda.drivers import HEALTH, Evidence, Joint, Jointed, Robot
from arboleda_drivers.ros_action.health import Health

SHORTEST_S = 0.1
# A move from rest to rest along a polynomial of the fifth degree is faster at its middle than on average,
# and accelerates most at a fifth of its way: by these factors of distance / time and distance / time squared.
PEAK_SPEED = 15 / 8
PEAK_ACCELERATION = 10 / math.sqrt(3)


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Settings of the driver `joint_trajectory`: action, joint states and joint names of the arm.

    `speed_percent` is of what the model of the arm allows; `lan` lets the driver reach other machines.
    `health` says which topic tells of the arm's stops, and what leads out of them.
    """

    action: str = "joint_trajectory_controller/follow_joint_trajectory"
    joint_states: str = "joint_states"
    joints: tuple[str, ...] = ()
    speed_percent: int = 50
    lan: bool = False
    health: Health | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.speed_percent <= 100:
            raise ValueError(f"speed_percent is {self.speed_percent}; allowed: 1 to 100")
        if len(set(self.joints)) < len(self.joints):
            raise ValueError("joints has a name twice")
        for name in ("action", "joint_states"):
            if not getattr(self, name):
                raise ValueError(f"{name} is empty; it is a name of ROS 2")

    @property
    def model_speed_share(self) -> float:
        """The share of the model's speed: a polynomial's mean speed is below that of its middle."""
        return self.speed_percent / 100 / PEAK_SPEED

    @property
    def reported_facts(self) -> tuple[str, ...]:
        """The facts that the driver reports beside those of the arm's kind."""
        return () if self.health is None else (HEALTH,)

    @property
    def home_clears_faults(self) -> bool:
        """True where homing leads the arm out of a fault."""
        return self.health is not None and self.health.clear != ()

    def joint_names(self, arm: Jointed) -> tuple[str, ...]:
        """The names of the arm's joints in ros2_control, in the arm's order."""
        return self.joints or tuple(joint.name for joint in arm.joints)

    def duration_s(self, arm: Jointed, start: Sequence[float], goal: Sequence[float]) -> float:
        """The least duration of a move, s, at which no joint exceeds its share of the model's limits."""
        share = self.speed_percent / 100
        ways = zip(arm.joints, start, goal, strict=True)
        times_s = [_least_s(joint, abs(there - here), share) for joint, here, there in ways]
        return max(SHORTEST_S, *times_s)

    def problems(self, device: Robot) -> Iterable[tuple[tuple[str | int, ...], str]]:
        """Settings that do not fit a device, each as its keys and a sentence."""
        if not isinstance(device, Jointed):
            yield (), f"{device.name} has no joints; a joint trajectory controller moves robots of joints"
        elif self.joints and len(self.joints) != len(device.joints):
            count = len(device.joints)
            yield ("joints",), f"there are {len(self.joints)} names for the {count} joints of {device.name}"
        if device.evidence is not Evidence.IDS:
            yield (), f"{device.name} has evidence: {device.evidence.value}; an action proves ids"


def _least_s(joint: Joint, distance: float, share: float) -> float:
    by_speed_s = PEAK_SPEED * distance / (joint.speed * share)
    by_acceleration_s = math.sqrt(PEAK_ACCELERATION * distance / (joint.acceleration * share))
    return max(by_speed_s, by_acceleration_s)
