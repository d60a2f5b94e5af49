"""Robots of a cell by their reports: where each is, what it reports, and what keeps it from a command."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.dispatcher import Dispatcher
from arboleda.dispatch.stillness import ReportMoment
from arboleda.model.commands import Position
from arboleda.model.facts import Value
from arboleda.model.messages import Failure, MotionState
from arboleda.model.plant_model import Cell, Evidence, Pose, is_homed_by_word

from .cell_devices import CellDevices
from .cell_time import CellTime


@dataclass(frozen=True, kw_only=True)
class Planned:
    """Places of the robots when a tree was made, by which its recipe may have planned."""

    standing: Mapping[str, str]  # the zone-free poses of those with shared zones, by name
    positions: Mapping[str, Position]


class CellRobots:
    """Beliefs about the robots of one cell, and what follows from them for a plan or a command.

    While the tree of an earlier start is made anew, robots count as standing where `as_planned` has them.
    """

    def __init__(self, cell: Cell, dispatcher: Dispatcher, time: CellTime, devices: CellDevices) -> None:
        self.as_planned: Planned | None = None
        self._cell = cell
        self._dispatcher = dispatcher
        self._time = time
        self._devices = devices

    def revise(self, cell: Cell) -> None:
        """Go by another version of the cell from now on."""
        self._cell = cell

    def belief(self, robot: str) -> Belief:
        return self._dispatcher.beliefs[robot]

    def fact(self, robot: str, name: str) -> Value | None:
        """The value that a robot reports for a fact; None where it reports none, or is not heard."""
        belief = self._dispatcher.beliefs[robot]
        return belief.fact(name) if belief.online else None

    def position(self, robot: str) -> Position | None:
        """The known position of a robot."""
        if self.as_planned is not None:
            return self.as_planned.positions.get(robot)
        return self._dispatcher.beliefs[robot].known_position

    def is_out_of_sight(self, robot: str) -> bool:
        """True where a robot that reports its position is silent, or its position means nothing."""
        belief = self._dispatcher.beliefs[robot]
        return self.as_planned is None and belief.position is not None and not belief.is_located

    def standing(self, robot: str) -> Pose:
        """The zone-free pose at which a robot's next way begins: where it is seen, else its home.

        A shared robot that another cell holds begins at home: there it is handed over.
        """
        space = self._cell.workspaces[robot]
        if robot in self._cell.shared and not self._devices.holds(robot):
            return space.home
        if self.as_planned is not None:
            name = self.as_planned.standing.get(robot)
            return next((pose for pose in space.poses if pose.name == name), space.home)
        return self._dispatcher.whereabouts.place(space) or space.home

    def planned(self) -> Planned:
        """The places of the robots now, by which a recipe may plan; no positions of shared robots."""
        standing = {robot: self.standing(robot).name for robot in self._cell.workspaces}
        own = [robot for robot in self._cell.reach if robot not in self._cell.shared]
        positions = {robot: self.position(robot) for robot in own}
        return Planned(
            standing=standing, positions={name: at for name, at in positions.items() if at is not None}
        )

    def is_down_elsewhere(self, robot: str, goal: Pose) -> bool:
        """True where a robot is at, or on the way down to, another target with an approach than its goal.

        A robot at a target without an approach, as its home, counts as up, whatever other targets are there.
        """
        space, here = self._cell.reach[robot], self._stands_at(robot)
        lifted = [(pose, pose.above) for pose in space.poses if pose.above is not None]
        level = [pose.q for pose in space.poses if pose.above is None]
        motion = space.robot.motion
        if here is None or any(motion.stands_at(here, q) for q in (*level, *(above for _, above in lifted))):
            return False
        down = [pose for pose, above in lifted if motion.is_between(here, pose.q, above)]
        return bool(down) and goal not in down

    def _stands_at(self, robot: str) -> Position | None:
        """The place of a robot that stands; at `state` the goal of its last move, as its reports are late."""
        if self.as_planned is not None or self._dispatcher.beliefs[robot].supervised:
            return self.position(robot)
        return self._dispatcher.whereabouts.reached.get(robot) or self.position(robot)

    def risen(self, robot: str) -> Position:
        """The position of a robot lifted to its highest approach; home where its position is unknown."""
        space, here = self._cell.reach[robot], self.position(robot)
        heights = [pose.above for pose in space.poses if pose.above]
        return space.robot.motion.lifted(here, heights) if here is not None and heights else space.home.q

    def obstacle(self, robot: str, *, was: bool = False) -> Failure | None:
        """The reason why a robot takes no command now; `was`: in words that stay true.

        A shared device that moves is no obstacle: another cell may be using it. A robot that the cell holds
        has to stand still.
        """
        shares = robot in self._cell.shared and robot not in self._dispatcher.latches.stopped
        if shares and (stop := self._devices.not_reset(robot)) is not None:
            return stop
        if shares and self._dispatcher.beliefs[robot].moves and not self._has_to_rest(robot):
            return None
        return self._dispatcher.obstacles.of(robot, was=was)

    def _has_to_rest(self, robot: str) -> bool:
        """True for a shared robot that goes from place to place, while this cell holds it."""
        return robot in self._cell.reach and self._devices.holds(robot)

    def obstacle_besides_stop(self, robot: str) -> Failure | None:
        """The reason why the robot would take no command even without its stop."""
        return self._dispatcher.beliefs[robot].obstacle_besides_stop()

    def homes_by_routine(self, robot: str) -> bool:
        """True for a robot that finds its reference by itself; a person puts any other robot there."""
        belief = self._dispatcher.beliefs[robot]
        knows = belief.robot.says_homed or belief.says_unhomed
        return belief.robot.evidence is Evidence.IDS and knows and not is_homed_by_word(belief.robot)

    def receiving(self, names: Iterable[str]) -> list[tuple[Belief, int]]:
        """The beliefs about these robots, and about those of the cell whose boards number their commands.

        Each comes with the number of commands that may have reached the robot and that it has not named yet.
        """
        beliefs, unnamed = self._dispatcher.beliefs, self._dispatcher.unnamed.ids
        told = set(names)
        for robot in self._cell.reached:
            if robot.name not in told and beliefs[robot.name].numbers_commands:
                told.add(robot.name)
        receiving = []
        for name in sorted(told):
            receiving.append((beliefs[name], len(unnamed.get(name, ()))))
        return receiving

    def moments(self) -> dict[str, ReportMoment]:
        """This moment in the reports of each robot of the cell, for `moving_since`."""
        beliefs, now = self._dispatcher.beliefs, self._time.plant_now
        return {robot.name: ReportMoment(beliefs[robot.name].reports, now) for robot in self._cell.robots}

    def moving_since(self, moments: dict[str, ReportMoment]) -> list[str]:
        """The online robots that were not seen still since these moments, but for those that finish work."""
        ending = [name for name in moments if not self._dispatcher.ledger.finishes(name)]
        online = {name: belief for name in ending if (belief := self._dispatcher.beliefs[name]).online}
        return [name for name, each in online.items() if not each.stillness.still_since(moments[name])]

    def latched(self) -> list[str]:
        """The online robots of the cell that report that they are stopped, and are not by the plant."""
        stopped = self._dispatcher.latches.stopped  # by another cell that shares them
        names = [robot.name for robot in self._cell.robots if robot.name not in stopped]
        beliefs = [self._dispatcher.beliefs[name] for name in names]
        return [each.robot.name for each in beliefs if each.online and each.state is MotionState.STOP_LATCHED]
