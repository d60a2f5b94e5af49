"""The cell that the storage recipes work in: an arm, a mobile robot and a rack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.commands import Position
from arboleda.model.plant_model import Cell, Crossing, Pose, Positions, Robot, Workspace
from arboleda.model.sentence import OWN, Phrase, Sentence
from arboleda.trees.steps import PieceCheck

HOME = "home"
ARM, MOBILE = "arm", "mobile"  # its roles, which are keys of the cell as well
ROLES = {ARM: Phrase("text.arm", "arm"), MOBILE: Phrase("text.mobile", "mobile")}


@dataclass(frozen=True, kw_only=True)
class Path:
    """A coded way of the mobile over its grid, node by node."""

    code: str
    nodes: tuple[int, ...]

    @property
    def exit(self) -> str:
        """What its code calls its last node: the second character."""
        return self.code[1]


@dataclass(frozen=True, kw_only=True)
class Palletizing:
    """The fixed pick and place of a cell's palletizing recipe."""

    pick: Pose
    place: Pose


@dataclass(frozen=True, kw_only=True)
class StorageCell(Cell):
    """One arm, one mobile robot, one storage rack; `pickup` serves each exit that `pickups` does not name."""

    is_storage: ClassVar[bool] = True

    arm: Arm
    mobile: Mobile
    home: Pose
    pickup: Pose
    paths: tuple[Path, ...]
    palletizing: Palletizing
    drive_to_start: bool  # False: a mobile known to be elsewhere fails the task
    piece_check: PieceCheck = "auto"
    crossings: tuple[Crossing, ...] = ()
    pickups: tuple[tuple[str, Pose], ...] = ()  # by exit
    keyed_roles: ClassVar[tuple[str, ...]] = (ARM, MOBILE)

    def role_said(self, role: str) -> Sentence | str:
        return ROLES[role]() if role in ROLES else role

    def described(self) -> dict[str, object]:
        grid = self.mobile.grid
        return {
            "grid": {"rows": grid.rows, "columns": grid.columns},
            "paths": {path.code: list(path.nodes) for path in self.paths},
        }

    @cached_property
    def drawing(self) -> dict[str, object]:
        return {
            "arm": self.arm.name,
            "mobile": self.mobile.name,
            "pitch": self.mobile.grid.pitch,
            "columns": self.mobile.grid.columns,
            "pickups": [list(pickup.joints) for pickup in self.every_pickup],
            "stations": [list(station.joints) for station in self.stations],
        }

    def part_waits(self, recipe: str) -> Pose | None:
        return self.palletizing.pick if recipe == "palletizing" else None

    def pickup_of(self, path: Path) -> Pose:
        """Where the arm takes the part at the end of a path."""
        return dict(self.pickups).get(path.exit, self.pickup)

    def pickup_over(self, node: Position | None) -> Pose:
        """Where the arm meets a mobile that stands on this node; None, or no exit: the one for all exits."""
        return next((self.pickup_of(path) for path in self.paths if path.nodes[-1] == node), self.pickup)

    def refuses_triggers(self, at_work: Sequence[str]) -> str | None:
        own_cycle = "palletizing" in at_work
        return self.arm.name if own_cycle and not self.arm.queue_triggers else None

    def start_of(self, robot: str) -> Position:
        return self.paths[0].nodes[0] if robot == self.mobile.name else self.home.q

    def supplies(self, robot: str) -> tuple[Pose, ...]:
        return (*self.every_pickup, self.palletizing.pick)

    def back(self, robot: str, positions: Positions) -> Pose:
        return self.pickup_over(positions(self.mobile.name))

    def path(self, code: str) -> Path:
        return next(path for path in self.paths if path.code == code)

    @cached_property
    def roles(self) -> dict[str, Robot]:
        return {"arm": self.arm, "mobile": self.mobile}

    def with_robots(self, change: Callable[[Robot], Robot]) -> StorageCell:
        arm, mobile = change(self.arm), change(self.mobile)
        assert isinstance(arm, Arm) and isinstance(mobile, Mobile)
        return replace(self, arm=arm, mobile=mobile)

    @cached_property
    def workspaces(self) -> dict[str, Workspace]:
        arm = Workspace(robot=self.arm, home=self.home, poses=self.poses, crossings=self.crossings)
        return {self.arm.name: arm}

    @cached_property
    def reach(self) -> dict[str, Workspace]:
        """Recipes of one's own send the mobile robot, too: to where paths begin and end."""
        start = self.paths[0].nodes[0]
        ends = tuple(Pose(name=path.code, title=OWN(text=path.code), q=path.nodes[-1]) for path in self.paths)
        home = Pose(name=HOME, title=OWN(text=HOME), q=start)
        return {
            **self.workspaces,
            self.mobile.name: Workspace(robot=self.mobile, home=home, poses=(home, *ends)),
        }

    def spots(self, robot: str) -> dict[str, Pose]:
        """Of the arm `home`, `pickup`, `pickup_b`, `station_7`; of the mobile `home`, the codes of paths."""
        if robot != self.arm.name:
            return super().spots(robot)
        return {HOME: self.home, **self._pickups, **self._stations}

    @cached_property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """What a recipe can have chosen."""
        codes = tuple(path.code for path in self.paths)
        return {"stations": tuple(self._stations), "pickups": tuple(self._pickups), "paths": codes}

    @property
    def _stations(self) -> dict[str, Pose]:
        return {f"station_{number}": pose for number, pose in enumerate(self.stations)}

    @property
    def _pickups(self) -> dict[str, Pose]:
        by_exit = {f"pickup_{path.exit.lower()}": self.pickup_of(path) for path in self.paths}
        return {"pickup": self.pickup} | by_exit

    @cached_property
    def zones(self) -> frozenset[str]:
        """Every shared zone that the arm may get into."""
        return self.workspaces[self.arm.name].zones

    @cached_property
    def poses(self) -> tuple[Pose, ...]:
        """Every named pose of the arm; a palletizing pose is one of them."""
        return (self.home, *self.every_pickup, *self.stations)

    @cached_property
    def every_pickup(self) -> tuple[Pose, ...]:
        """The pick-ups of all exits, each once."""
        return tuple({pose.name: pose for pose in (self.pickup, *dict(self.pickups).values())}.values())
