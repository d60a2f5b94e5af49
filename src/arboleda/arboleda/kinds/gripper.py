"""A gripper with two fingers: it closes on a part with a force, and says whether it has one."""

from __future__ import annotations

from dataclasses import dataclass

from arboleda.kinds import Kind, KindError, Number, kind, switch


@dataclass(frozen=True, kw_only=True)
class GripperSettings:
    """Settings of a gripper: its opening, mm, its greatest force, N, and the time to move, s."""

    max_width_mm: float = 85.0
    max_force_n: float = 140.0
    takes_s: float = 0.5
    at_most_s: float = 5.0

    def __post_init__(self) -> None:
        if self.max_width_mm <= 0 or self.max_force_n <= 0:
            raise KindError("max_width_mm and max_force_n must be more than 0")


@kind("gripper")
def gripper(settings: GripperSettings) -> Kind:
    """Closes on a part with a width and a force, and says whether it has gripped it."""
    return Kind(
        facts={"gripped": bool, "width_mm": float, "force_n": float},
        verbs={
            "close": switch(
                parameters={
                    "width_mm": Number(0.0, settings.max_width_mm),
                    "force_n": Number(0.0, settings.max_force_n),
                },
                sets={"gripped": True},  # width and force depend on the part, so they prove nothing
                holds_part=True,
                virtual=lambda facts, width_mm, force_n: {"width_mm": width_mm, "force_n": force_n},
                takes_s=settings.takes_s,
                at_most_s=settings.at_most_s,
            ),
            "open": switch(
                sets={"gripped": False},
                holds_part=True,
                virtual=lambda facts: {"width_mm": settings.max_width_mm, "force_n": 0.0},
                takes_s=settings.takes_s,
                at_most_s=settings.at_most_s,
            ),
        },
    )
