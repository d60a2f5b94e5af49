"""What a plant is: frozen values in SI units (rad, m, s), built once from the plant file."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from .commands import Command, FollowPath, MoveJoints, Position, SetEffector
from .counting import counted
from .recipe import Recipe
from .sentence import NOTHING, OWN, Sentence

if TYPE_CHECKING:
    from .messages import Report

Positions = Callable[[str], "Position | None"]
"""Where a robot of this name is known to be."""


class Evidence(str, Enum):
    """How much a robot can prove about its motion."""

    IDS = "ids"
    JOINTS = "joints"
    STATE = "state"


class Link(str, Enum):
    """How a robot is reached: MQTT through the bridge, directly on ROS 2 topics, or not: it is only drawn."""

    MQTT = "mqtt"
    ROS = "ros"
    NONE = "none"


class ForeignCommands(str, Enum):
    """What a bridge that hears its plant does with commands of other nodes; stops it always obeys."""

    REFUSE = "refuse"
    OBEY = "obey"


class MqttVersion(str, Enum):
    """Which MQTT a plant speaks."""

    V3_1_1 = "3.1.1"
    V5 = "5"


class MotionState(int, Enum):
    """The code a robot reports as `motion_state` (ROS 2) and `estado` (MQTT)."""

    STOPPED = 0
    MOVING = 1
    FAULT = 2
    NOT_HOMED = 3
    STOP_LATCHED = 4
    NO_LINK = 255


@dataclass(frozen=True, kw_only=True)
class Joint:
    """One axis: position in rad (revolute) or m (prismatic); `step` is one motor step in that unit."""

    name: str
    lower: float
    upper: float
    speed: float
    acceleration: float
    step: float
    pinion_radius_m: float | None = None  # None: revolute; else the rack pinion of a prismatic axis
    up: int = -1  # which way a prismatic axis lifts: -1 towards smaller values, 1 greater ones, 0 neither

    @property
    def unit(self) -> str:
        return "rad" if self.pinion_radius_m is None else "m"

    def steps(self, value: float) -> int:
        """The whole motor step nearest to `value`, halves away from zero."""
        return math.floor(abs(value) / self.step + 0.5) * (1 if value >= 0 else -1)

    def quantised(self, value: float) -> float:
        """`value` as the motor can hold it."""
        return self.steps(value) * self.step

    def higher(self, value: float, *others: float) -> float:
        """The highest of these values where the joint lifts, else `value`."""
        if self.pinion_radius_m is None or self.up == 0:
            return value
        return min(value, *others) if self.up < 0 else max(value, *others)

    def travel_s(self, distance: float) -> float:
        """Time of a rest-to-rest move over `distance` with constant acceleration."""
        distance = abs(distance)
        ramp = self.speed**2 / self.acceleration
        if distance < ramp:
            return 2 * math.sqrt(distance / self.acceleration)
        return distance / self.speed + self.speed / self.acceleration


@dataclass(frozen=True, kw_only=True)
class Placement:
    """A pose on the floor of the `world` frame: m, m, rad."""

    x: float
    y: float
    yaw: float = 0.0


@dataclass(frozen=True, kw_only=True)
class Grid:
    """A rows x columns grid of nodes, numbered row by row from 0; `pitch` m between neighbours."""

    origin: Placement
    pitch: float
    rows: int = 3
    columns: int = 3

    @property
    def size(self) -> int:
        return self.rows * self.columns

    def neighbours(self, node: int) -> tuple[int, ...]:
        """The nodes one 4-neighbour edge away, ascending."""
        row, column = divmod(node, self.columns)
        around = ((row - 1, column), (row, column - 1), (row, column + 1), (row + 1, column))
        return tuple(r * self.columns + c for r, c in around if 0 <= r < self.rows and 0 <= c < self.columns)

    def route(self, start: int, goal: int) -> tuple[int, ...]:
        """A shortest way over 4-neighbours, both ends included; ties go to the lower node."""
        came_from = {start: start}
        frontier = deque([start])
        while goal not in came_from:
            node = frontier.popleft()
            for nearby in self.neighbours(node):
                if nearby not in came_from:
                    came_from[nearby] = node
                    frontier.append(nearby)
        way = [goal]
        while way[-1] != start:
            way.append(came_from[way[-1]])
        return tuple(reversed(way))

    def position(self, node: int) -> tuple[float, float]:
        """x, y of a node in the grid frame, m."""
        row, column = divmod(node, self.columns)
        return (column * self.pitch, row * self.pitch)


@dataclass(frozen=True, kw_only=True)
class Robot:
    """What every robot declares: its names, its link and what it can prove."""

    name: str
    mqtt: str
    link: Link
    evidence: Evidence
    timeout_s: float
    assume_homed: bool = False
    home_at_start: bool = False  # True: homed by the plant when it starts, if it is not
    has_stop: bool = True
    piece_on_change: bool = False  # True: its piece sensor speaks only when the value changes
    position_key: ClassVar[str | None] = None  # the key of a report that has its position, if any

    @property
    def held_fact(self) -> str | None:
        """The fact, a yes or no, that says whether it holds something; None where it cannot hold anything."""
        return None

    @property
    def units(self) -> list[str] | None:
        """The unit of each number of its position; None where that is no list of numbers."""
        return None

    def objection(self, report: Report) -> str | None:
        """Why it cannot have said this; None where it can."""
        return None

    @property
    def works(self) -> bool:
        """Whether it can be given work; what only answers or switches always stands still."""
        return True

    @property
    def reference(self) -> Position | None:
        """Where its position is counted from; None where it counts nothing that a boot could lose."""
        return None

    def go(self, *, id: str, way: Sequence[Position]) -> Command:
        """The command that brings it along `way` to its last position."""
        raise NotImplementedError

    def let_go(self, *, id: str) -> Command:
        """The command that opens its effector."""
        raise NotImplementedError

    def stands_at(self, position: Position, goal: Position) -> bool:
        """Whether a reported position is that goal."""
        return position == goal

    def held_at(self, position: Position) -> Position:
        """The position as its motors can hold it."""
        return position

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """The position, raised to all of these heights where that is possible."""
        return position

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a motion along `way`; from an unknown start the longest possible one."""
        raise NotImplementedError

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        """Whether its limits allow it to come from one position to the other in that time."""
        return True

    @property
    def says_homed(self) -> bool:
        """Whether it knows itself if it is homed; a board that assumes so after every boot does not."""
        return self.evidence is Evidence.IDS and not self.assume_homed


@dataclass(frozen=True, kw_only=True)
class Description:
    """A model of the plant's own: its URDF without a prefix, and what was assumed of it."""

    urdf: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Arm(Robot):
    """An arm; `tolerance` per joint overrides the default of half a motor step + 1e-5."""

    model: str
    twin: str
    base: Placement
    joints: tuple[Joint, ...]
    tolerance: tuple[float, ...] | None = None
    queue_triggers: bool = True  # False: a start trigger during the arm's own cycle is refused
    description: Description | None = None  # None: the model comes with arboleda_description
    position_key: ClassVar[str | None] = "q"

    @property
    def held_fact(self) -> str:
        return "effector"

    @property
    def units(self) -> list[str]:
        return [joint.unit for joint in self.joints]

    def objection(self, report: Report) -> str | None:
        if report.node is not None:
            return f"node is {report.node}; {self.name} is an arm and stands on no node"
        if report.q is not None and len(report.q) != len(self.joints):
            has = f"{self.name} has {counted(len(self.joints), 'joint')}"
            return f"q has {counted(len(report.q), 'value')}; {has}"
        return None

    def go(self, *, id: str, way: Sequence[Position]) -> MoveJoints:
        goal = way[-1]
        assert isinstance(goal, tuple)
        return MoveJoints(id=id, robot=self.name, q=goal)

    def let_go(self, *, id: str) -> SetEffector:
        return SetEffector(id=id, robot=self.name, on=False)

    @cached_property
    def reference(self) -> tuple[float, ...]:
        """Where the homing routine ends, and the counters begin."""
        return (0.0,) * len(self.joints)

    @cached_property
    def tolerances(self) -> tuple[float, ...]:
        return self.tolerance or tuple(joint.step / 2 + 1e-5 for joint in self.joints)

    def quantised(self, q: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(joint.quantised(value) for joint, value in zip(self.joints, q, strict=True))

    def held_at(self, position: Position) -> Position:
        assert isinstance(position, tuple)
        return self.quantised(position)

    def lifted(self, position: Position, heights: Sequence[Position]) -> Position:
        """Only prismatic joints lift; how, each of them says."""
        assert isinstance(position, tuple)
        rows = zip(self.joints, position, *[up for up in heights if isinstance(up, tuple)], strict=True)
        return tuple(joint.higher(q, *above) for joint, q, *above in rows)

    def reached(self, q: tuple[float, ...], target: tuple[float, ...]) -> bool:
        """Whether reported joints `q` lie within tolerance of a quantised target."""
        rows = zip(q, target, self.tolerances, strict=True)
        return all(abs(value - goal) <= tolerance for value, goal, tolerance in rows)

    def stands_at(self, position: Position, goal: Position) -> bool:
        assert isinstance(position, tuple) and isinstance(goal, tuple)
        return self.reached(position, self.quantised(goal))

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a joint move; from an unknown start, or one that cannot be, the longest possible one."""
        longest_s = max(joint.travel_s(joint.upper - joint.lower) for joint in self.joints)
        if start is None:
            return longest_s
        assert isinstance(start, tuple) and isinstance(way[-1], tuple)
        rows = zip(self.joints, start, way[-1], strict=True)
        return min(longest_s, max(joint.travel_s(there - here) for joint, here, there in rows))

    def can_have_moved(self, before: Position, after: Position, elapsed_s: float) -> bool:
        assert isinstance(before, tuple) and isinstance(after, tuple)
        rows = zip(self.joints, before, after, strict=True)
        return all(abs(now - then) <= joint.speed * elapsed_s + 2 * joint.step for joint, then, now in rows)


@dataclass(frozen=True, kw_only=True)
class Mobile(Robot):
    """A mobile robot on a grid; `speed` in m/s."""

    model: str
    grid: Grid
    speed: float
    position_key: ClassVar[str | None] = "node"

    def objection(self, report: Report) -> str | None:
        for key in ("q", "effector", "piece"):
            if getattr(report, key) is not None:
                return f"{key} was said; {self.name} is a mobile robot and has none"
        if report.node is not None and not 0 <= report.node < self.grid.size:
            return f"node is {report.node}; {self.name} knows {self.grid.size} nodes"
        return None

    def go(self, *, id: str, way: Sequence[Position]) -> FollowPath:
        return FollowPath(id=id, robot=self.name, nodes=tuple(node for node in way if isinstance(node, int)))

    def travel_s(self, start: Position | None, way: Sequence[Position]) -> float:
        """Time of a path; one edge is added for a robot that starts elsewhere."""
        return len(way) * self.grid.pitch / self.speed


@dataclass(frozen=True, kw_only=True)
class Pose:
    """A named arm pose; `above` the point over it where it has an approach height, `zones` where it lies."""

    name: str
    q: tuple[float, ...]
    above: tuple[float, ...] | None = None
    zones: frozenset[str] = frozenset()
    title: Sentence = NOTHING

    @property
    def said(self) -> Sentence:
        """Its name as sentences have it."""
        return self.title or OWN(text=self.name)


@dataclass(frozen=True, kw_only=True)
class Crossing:
    """The moves between two zone-free poses, in either direction, that cross zones."""

    a: str  # names of poses
    b: str
    zones: frozenset[str]


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
class Retry:
    """How often a failed step is tried again, where that can help, and the pause before each, s."""

    times: int = 0
    backoff_s: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """Where one robot goes in its cell, and which shared zones lie on its ways."""

    robot: Robot
    home: Pose  # where it waits, and where a recovery ends
    poses: tuple[Pose, ...]  # home is one of them
    crossings: tuple[Crossing, ...] = ()

    @cached_property
    def zones(self) -> frozenset[str]:
        """Every shared zone that it may get into."""
        places = (pose.zones for pose in self.poses)
        return frozenset[str]().union(*places, *(crossing.zones for crossing in self.crossings))

    @cached_property
    def free_spots(self) -> tuple[tuple[Position, Pose], ...]:
        """Each position at, or above, a zone-free pose, with that pose.

        The robot's reference counts as home: homing leads there, and both lie outside all zones.
        """
        free = [pose for pose in self.poses if not pose.zones]
        spots: list[tuple[Position, Pose]] = []
        spots += [(q, pose) for pose in free for q in (pose.q, pose.above) if q is not None]
        reference = self.robot.reference
        if reference is not None and all(pose.q != reference for pose in self.poses):
            spots.append((reference, self.home))
        return tuple((self.robot.held_at(q), pose) for q, pose in spots)


@dataclass(frozen=True, kw_only=True)
class Cell:
    """Robots that carry out one task at a time, each in a role of its own."""

    name: str
    members: tuple[tuple[str, Robot], ...] = ()  # by role
    spaces: tuple[Workspace, ...] = ()  # of those that go from pose to pose
    queue_limit: int
    retry: Retry = Retry()
    zone_wait_s: float = 30.0
    recipes: tuple[Recipe, ...] = ()
    stations: tuple[Pose, ...] = ()  # by number: where parts stay until somebody takes them out

    @cached_property
    def roles(self) -> dict[str, Robot]:
        """Its robots by what they are in it, in the order of the file."""
        return dict(self.members)

    @cached_property
    def workspaces(self) -> dict[str, Workspace]:
        """By the name of each robot that goes from pose to pose."""
        return {space.robot.name: space for space in self.spaces}

    def recipe(self, name: str) -> Recipe:
        return next(recipe for recipe in self.recipes if recipe.name == name)

    def refuses_triggers(self, at_work: Sequence[str]) -> str | None:
        """Whose own cycle keeps start signals of machines away, while tasks of these recipes run or wait."""
        return None

    def back(self, robot: str, positions: Positions) -> Pose | None:
        """Where a recovery brings a part whose origin nobody knows; None: the robot keeps it."""
        return None

    @cached_property
    def robots(self) -> tuple[Robot, ...]:
        return tuple(self.roles.values())

    @cached_property
    def reached(self) -> tuple[Robot, ...]:
        """Its robots without those that are only drawn."""
        return tuple(robot for robot in self.robots if robot.link is not Link.NONE)

    @cached_property
    def holders(self) -> tuple[str, ...]:
        """The robots that can hold a part."""
        return tuple(robot.name for robot in self.robots if robot.held_fact is not None)

    @cached_property
    def zone_users(self) -> tuple[str, ...]:
        """The robots that may get into shared zones."""
        return tuple(name for name, workspace in self.workspaces.items() if workspace.zones)


@dataclass(frozen=True, kw_only=True)
class StorageCell(Cell):
    """One arm, one mobile robot, one storage rack; `pickup` serves each exit that `pickups` does not name."""

    arm: Arm
    mobile: Mobile
    home: Pose
    pickup: Pose
    paths: tuple[Path, ...]
    palletizing: Palletizing
    drive_to_start: bool = True  # False: a mobile known to be elsewhere fails the task
    piece_check: bool = False
    crossings: tuple[Crossing, ...] = ()
    pickups: tuple[tuple[str, Pose], ...] = ()  # by exit

    def pickup_of(self, path: Path) -> Pose:
        """Where the arm takes the part at the end of a path."""
        return dict(self.pickups).get(path.exit, self.pickup)

    def pickup_over(self, node: Position | None) -> Pose:
        """Where the arm meets a mobile that stands on this node; None, or no exit: the one for all exits."""
        return next((self.pickup_of(path) for path in self.paths if path.nodes[-1] == node), self.pickup)

    def refuses_triggers(self, at_work: Sequence[str]) -> str | None:
        own_cycle = "palletizing" in at_work
        return self.arm.name if own_cycle and not self.arm.queue_triggers else None

    def back(self, robot: str, positions: Positions) -> Pose:
        return self.pickup_over(positions(self.mobile.name))

    def path(self, code: str) -> Path:
        return next(path for path in self.paths if path.code == code)

    @cached_property
    def roles(self) -> dict[str, Robot]:
        return {"arm": self.arm, "mobile": self.mobile}

    @cached_property
    def workspaces(self) -> dict[str, Workspace]:
        arm = Workspace(robot=self.arm, home=self.home, poses=self.poses, crossings=self.crossings)
        return {self.arm.name: arm}

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


@dataclass(frozen=True, kw_only=True)
class Timing:
    """The plant's waiting times in seconds; `deadline_factor` multiplies a computed motion time."""

    dwell_s: float = 0.2
    effector_settle_s: float = 0.2
    effector_timeout_s: float = 5.0
    stale_after_s: float = 1.5
    stop_timeout_s: float = 5.0
    deadline_factor: float = 1.5
    deadline_floor_s: float = 2.0
    piece_wait_s: float = 2.0
    piece_debounce_s: float = 0.1


@dataclass(frozen=True, kw_only=True)
class PlantModel:
    """The whole plant as its file describes it."""

    name: str
    cells: tuple[Cell, ...]
    timing: Timing = Timing()
    mqtt_version: MqttVersion = MqttVersion.V3_1_1
    zones: tuple[str, ...] = ()
    foreign_commands: ForeignCommands = ForeignCommands.REFUSE

    def cell(self, name: str) -> Cell:
        return next(cell for cell in self.cells if cell.name == name)

    @cached_property
    def robots(self) -> dict[str, Robot]:
        """Every robot by name, in the order of the file."""
        return {robot.name: robot for cell in self.cells for robot in cell.robots}

    @cached_property
    def has_boards(self) -> bool:
        """Whether a robot is reached over MQTT; without one, nobody needs a broker."""
        return any(robot.link is Link.MQTT for robot in self.robots.values())

    @cached_property
    def cell_of(self) -> dict[str, Cell]:
        """The cell of each robot, by robot name."""
        return {robot.name: cell for cell in self.cells for robot in cell.robots}
