"""Arm: a robot of joints with an effector, a place on the floor and a model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from ..floor import Placement
from ..joints import Jointed
from .commands import SetEffector


@dataclass(frozen=True, kw_only=True)
class Arm(Jointed):
    """Robot of joints that takes and sets down parts with its effector."""

    kind_name: str = "arm"
    twin: str
    published_by: ClassVar[str] = "twin"
    base: Placement
    unsaid: ClassVar[tuple[str, ...]] = ("node",)

    @property
    def fact_names(self) -> tuple[str, ...]:
        return ("effector", *super().fact_names)

    def drawn(self) -> dict[str, object]:
        speeds = [joint.speed for joint in self.joints]
        return {"at": self.base.on_floor, "speeds": speeds, "reference": list(self.reference)}

    @property
    def held_fact(self) -> str:
        return "effector"

    def grip(self, *, id: str) -> SetEffector:
        return SetEffector(id=id, robot=self.name, on=True)

    def let_go(self, *, id: str) -> SetEffector:
        return SetEffector(id=id, robot=self.name, on=False)
