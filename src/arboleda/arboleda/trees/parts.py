"""Parts in the effectors of a cell: held, carried, lost, and where each belongs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.model.facts import Value
from arboleda.model.grips import Grip
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Cell, Pose
from arboleda.model.sentence import Phrase, Sentence

from .cell_devices import CellDevices
from .cell_robots import CellRobots
from .piece_sensors import PieceSensors

LOST = Phrase("part.lost", "{arm}: the part was lost on the way")


class Parts:
    """Books of the parts that the effectors of one cell hold.

    `carrier` is the robot on its way with a part that its sensor has seen. `back` has the pose from which
    each robot's part came, where that is known. `origins` are the robots for which the plant noted that pose,
    and no recipe gave it. `delivers`: work runs; in a recovery a lost part is no failure.
    """

    def __init__(
        self,
        cell: Cell,
        dispatcher: Dispatcher,
        devices: CellDevices,
        robots: CellRobots,
        sensors: PieceSensors,
    ) -> None:
        self.carrier: str | None = None
        self.delivers = True
        self.back: dict[str, Pose] = {}
        self.origins: set[str] = set()
        self._cell = cell
        self._dispatcher = dispatcher
        self._devices = devices
        self._effectors = dispatcher.effectors
        self._robots = robots
        self._sensors = sensors

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on; a part goes back to where its pose is by then."""
        self._cell = cell
        poses = {robot: cell.reach[robot].by_name.get(pose.name) for robot, pose in self.back.items()}
        self.back = {robot: pose for robot, pose in poses.items() if pose is not None}

    def begin(self) -> None:
        """Begin the books of another tree."""
        self.carrier, self.delivers = None, True
        for robot in filter(self._devices.answers_for, self._cell.holders):
            self._effectors.opened.pop(robot, None)

    def recover(self) -> None:
        """Begin a recovery, which delivers nothing."""
        self.carrier, self.delivers = None, False

    def take_over(self, *, carrier: str | None, origins: Iterable[str], back: Mapping[str, str]) -> None:
        """Take the books of a task of an earlier start; `back` has the names of poses."""
        self.carrier, self.origins = carrier, set(origins)
        reach = self._cell.reach
        poses = {robot: {pose.name: pose for pose in space.poses} for robot, space in reach.items()}
        named = {robot: poses.get(robot, {}).get(name) for robot, name in back.items()}
        self.back = {robot: pose for robot, pose in named.items() if pose is not None}

    def forget_origins(self) -> None:
        """Forget where parts come from, before a recipe says it anew."""
        self.back, self.origins = {}, set()

    def note_origin(self, robot: str, pose: Pose) -> None:
        """Note the pose from which an empty robot takes its next part, where a recovery brings that back."""
        given = robot in self.back and robot not in self.origins  # the recipe has set it
        if self._cell.reach[robot].hand.name not in self.holding and not given:
            self.back[robot] = pose
            self.origins.add(robot)

    def way_back(self, robot: str) -> Pose | None:
        """The pose to which a recovery brings a robot's part: where it was taken, else as the cell says."""
        if robot in self.origins and self._cell.workspaces[robot].hand.name not in self.holding:
            return None  # the robot went there, and took nothing
        return self.back.get(robot) or self._cell.back(robot, self._robots.position)

    def grip(self, robot: str) -> Grip:
        """The known state of a robot's effector."""
        return self._effectors.grips[robot]

    @property
    def grips(self) -> dict[str, Grip]:
        """The known state of each effector of the cell."""
        grips = self._effectors.grips
        return {name: grips[name] for name in self._cell.holders}

    @property
    def holding(self) -> list[str]:
        """The robots whose effector may hold a part, and for which this cell answers."""
        holding = [robot for robot in self._cell.holders if self._effectors.grips.holding(robot)]
        return [*filter(self._devices.answers_for, holding)] if holding and self._cell.shared else holding

    @property
    def witnessed(self) -> tuple[str, ...]:
        """The robots of the cell alone that report if they hold a part; no tools, which may open late."""
        tools = {space.tool.name for space in self._cell.spaces if space.tool is not None}
        beliefs = {robot: self._robots.belief(robot) for robot in self._cell.holders}
        reporting = (robot for robot, belief in beliefs.items() if belief.held_in(belief) is not None)
        return tuple(robot for robot in reporting if robot in self._cell.own and robot not in tools)

    @property
    def unopened(self) -> list[str]:
        """The robots that may hold a part, and whose last command to let go failed."""
        return [robot for robot in self.holding if robot in self._effectors.unopened]

    def obstacle_to_opening(self, robot: str) -> Failure | None:
        """The reason why a robot cannot let go now."""
        return self._dispatcher.obstacles.to_opening(robot)

    def opening_tool(self, robot: str) -> str | None:
        """The tool of a robot that may still let go of a part on an earlier command."""
        return self._effectors.opening_tool(robot)

    def lost(self) -> Failure | None:
        """The failure for a carried part that the piece sensor does not see any more."""
        robot = self.carrier
        if robot is None or self._sensors.read(robot, 0.0) is not False:
            return None
        return Failure(reason=Reason.PART_LOST, sentence=LOST(arm=robot))

    @property
    def opened_by(self) -> str | None:
        """The robot whose effector opened with a part in it without a command of this plant."""
        if not self._effectors.opened:
            return None
        opened = (robot for robot in self._cell.holders if robot in self._effectors.opened)
        return next(filter(self._devices.answers_for, opened), None)

    def opening(self, robot: str) -> Sentence:
        """The sentence about a robot whose effector opened so."""
        return self._effectors.opened[robot]

    def leave_unsettled(self, robot: str, *, sets: Mapping[str, Value]) -> None:
        """Note that an earlier start was switching the effector of a robot, to `sets`.

        A tool that was told to grip does not let go late.
        """
        if robot in self._cell.holders:
            self._effectors.cut_off.add(robot)
            if sets.get(self._dispatcher.model.robots[robot].held_fact or ""):
                self._effectors.grips.forget_opening(robot)

    def settle(self) -> None:
        """Believe the reports of effectors that an earlier start was switching."""
        for robot in filter(
            self._devices.answers_for, self._effectors.cut_off.intersection(self._cell.holders)
        ):
            self._effectors.settle_cut_off(self._robots.belief(robot))
