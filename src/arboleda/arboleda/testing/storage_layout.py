"""Parts of a shipped cell, by what they are to the recipes of storage; for tests and benchmarks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import cast

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.commands import Position
from arboleda.model.plant_model import Cell, Handover, Path, Pose, Workspace
from arboleda.recipes.storage import PALLETIZING_TARGETS


@dataclass(frozen=True)
class Palletizing:
    """The two poses of the arm's own cycle."""

    pick: Pose
    place: Pose


@dataclass(frozen=True)
class StorageLayout:
    """A cell seen as an arm that stores the parts which a mobile robot brings; it has a handover."""

    cell: Cell

    @property
    def name(self) -> str:
        """The name of the cell."""
        return self.cell.name

    @property
    def handover(self) -> Handover:
        """The poses at which the arm takes parts."""
        assert self.cell.handover is not None
        return self.cell.handover

    @cached_property
    def arm(self) -> Arm:
        """The robot that takes the parts."""
        return cast(Arm, self.cell.taker.robot)

    @cached_property
    def mobile(self) -> Mobile:
        """The robot that brings them."""
        return cast(Mobile, self.cell.giver.robot)

    @property
    def space(self) -> Workspace:
        """The places of the arm."""
        return self.cell.taker

    @property
    def home(self) -> Pose:
        """The pose at which the arm waits."""
        return self.space.home

    @property
    def stations(self) -> tuple[Pose, ...]:
        """The rack, by number."""
        return self.cell.stations

    @property
    def paths(self) -> tuple[Path, ...]:
        """The paths of the mobile robot."""
        return self.cell.giver.paths

    def path(self, code: str) -> Path:
        """The path with this code."""
        return self.cell.giver.path(code)

    @property
    def pickup(self) -> Pose:
        """The pose at which the arm takes parts after every path that has none of its own."""
        return self.space.targets[self.handover.otherwise]

    @cached_property
    def pickups(self) -> tuple[Pose, ...]:
        """The poses at which the arm takes parts, each once."""
        return self.space.at(self.handover.targets)

    def pickup_of(self, path: Path) -> Pose:
        """The pose at which the arm takes the part that came on this path."""
        return self.space.targets[self.handover.after(path.code)]

    def pickup_over(self, node: Position | None) -> Pose:
        """The pose at which the arm meets a mobile robot that stands on this node."""
        return self.cell.pickup_over(node)

    @cached_property
    def palletizing(self) -> Palletizing:
        """The poses of the arm's own cycle."""
        pick, place = self.cell.groups[PALLETIZING_TARGETS]
        return Palletizing(pick=self.space.targets[pick], place=self.space.targets[place])
