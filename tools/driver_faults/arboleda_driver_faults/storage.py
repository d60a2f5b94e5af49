"""Plant whose cell of storage has its arm behind a driver, for the campaigns of several drivers."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace

from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import Evidence, Link, PlantModel, Robot
from arboleda.testing.storage_layout import StorageLayout

from .rig import EPOCH, Rig


def plant_of(shipped: PlantModel) -> PlantModel:
    """The shipped plant's cell with an arm of six joints, which is behind a driver."""
    layouts = [StorageLayout(cell) for cell in shipped.cells if cell.handover]
    layout = next(each for each in layouts if len(each.arm.joints) == 6)

    def driven(robot: Robot) -> Robot:
        is_arm = robot.name == layout.arm.name
        return replace(robot, link=Link.DRIVER, evidence=Evidence.IDS) if is_arm else robot

    return replace(shipped, cells=(layout.cell.with_robots(driven),))


class StorageRig(Rig):
    """Test with parts that go from the pick to the place; it sees the arm's place and its output."""

    work = (("pick", True), ("place", True), ("place", False))
    near_rad = 3.5e-4

    def __init__(self, shipped: PlantModel, faults: Mapping[str, str]) -> None:
        super().__init__(faults)
        self.model = plant_of(shipped)
        (cell,) = self.model.cells
        self.layout = StorageLayout(cell)
        self._spots = {
            "home": self.layout.home.joints,
            "pick": self.layout.palletizing.pick.joints,
            "place": self.layout.palletizing.place.joints,
        }

    @property
    def robots(self) -> Sequence[Robot]:
        return [self.layout.arm]

    @property
    @abstractmethod
    def shows(self) -> tuple[Sequence[float], bool]:
        """The true joints of the arm, rad, and its output."""

    @property
    def where(self) -> tuple[float, ...]:
        return tuple(self.shows[0])

    def task(self, number: int) -> str:
        return f"{self.layout.name} palletizing #{number}"

    def place(self) -> tuple[str, bool] | None:
        joints, output = self.shows
        for name, spot in self._spots.items():
            if all(abs(a - b) < self.near_rad for a, b in zip(joints, spot, strict=True)):
                return (name, output)
        return None

    def bystanders(self, now: float) -> list[Report]:
        """The reports of the mobile robot, which stands still."""
        name, still = self.layout.mobile.name, MotionState.STOPPED
        return [
            Report(at=now, robot=name, epoch=EPOCH, plant=EPOCH, boot_id=1, state=still, node=0, homed=True)
        ]
