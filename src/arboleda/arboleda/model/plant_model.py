"""Model of a plant: frozen values in SI units (rad, m, s), built once from the plant file."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import Any, ClassVar, Literal

from .assistants import NO_LIMITS, AssistantLimits, Assistants
from .commands import Command, Position
from .errors import ArboledaError
from .facts import Facts, Value
from .messages import MotionState, Report
from .movement import Movement
from .recipe import Recipe
from .sentence import NOTHING, OWN, Sentence

STATIONS = "stations"
"""The group of targets at which a cell with a handover leaves parts."""
Positions = Callable[[str], "Position | None"]
"""Function that returns the known position of the robot of this name."""
PieceCheck = bool | Literal["auto"]
"""A look at the piece sensor around grips; auto: where the robot's board reports what that sees."""


APART_S = 0.2
"""Two telemetry periods: by how much a state and a position of one instant may come apart."""
QUIET_S = 0.3
"""A telemetry period, in which a command gets to its robot, and APART_S for the answer."""


class Evidence(str, Enum):
    """Evidence that a robot can give of its motion."""

    IDS = "ids"
    JOINTS = "joints"
    STATE = "state"


class Link(str, Enum):
    """Link to a robot: MQTT through the bridge, ROS 2 topics, or none where it is only drawn.

    By DRIVER it is reached by a driver of somebody's own. Who is reached by SCREEN is a person, who answers
    on the page, on the command line, over HTTP or ROS 2.
    """

    MQTT = "mqtt"
    ROS = "ros"
    NONE = "none"
    SCREEN = "screen"
    DRIVER = "driver"


class ForeignCommands(str, Enum):
    """Treatment of commands of other nodes by a bridge that hears its plant; stops it always obeys."""

    REFUSE = "refuse"
    OBEY = "obey"


class MqttVersion(str, Enum):
    """Version of MQTT that a plant speaks."""

    V3_1_1 = "3.1.1"
    V5 = "5"


@dataclass(frozen=True, kw_only=True)
class DriverUse:
    """The driver that reaches a robot, and its settings; `make` makes one with them. `pace` is the share of
    its model's speed at which it moves the robot. `facts` names the facts that it reports beside those of the
    robot's kind. `recovers`: homing leads the robot out of a fault. `home_moves`: homing moves it.
    `home_is_claim`: homing is the word of a person that the robot stands at its zero. `watches_plant`: the
    device ends its work by itself once the plant is gone.
    """

    name: str
    settings: object = field(default=None, hash=False)
    pace: float = 1.0
    facts: tuple[str, ...] = ()
    recovers: bool = False
    home_moves: bool = True
    home_is_claim: bool = False
    watches_plant: bool = False
    make: Callable[[], Any] = field(compare=False, repr=False)


@dataclass(frozen=True, kw_only=True)
class JointStates:
    """Joint states of a robot on ROS 2, under the name `twin`: the names of its joints, none where it reports
    no position, and their `measured` values in a report.
    """

    twin: str
    joints: tuple[str, ...] = ()
    measured: Callable[[Report], tuple[float, ...] | None] | None = None

    @property
    def topic(self) -> str:
        """The topic on which they are published."""
        return f"{self.twin}/joint_states"

    def values(self, report: Report) -> tuple[float, ...] | None:
        """The value of each joint, x and y of a mobile robot; None where there is none, or no link."""
        if self.measured is None or report.state is MotionState.NO_LINK:
            return None
        return self.measured(report)


@dataclass(frozen=True, kw_only=True)
class Robot:
    """Declaration of a robot: its names, its link and what it can prove."""

    name: str
    mqtt: str
    link: Link
    evidence: Evidence
    timeout_s: float
    assume_homed: bool = False
    home_at_start: bool = False  # True: homed by the plant when it starts, if it is not
    has_stop: bool = True
    driver: DriverUse | None = None  # with `Link.DRIVER`
    piece_on_change: bool = False  # True: its piece sensor speaks only when the value changes
    queue_triggers: bool = True  # False: a start trigger during the robot's own cycle is refused
    position_key: ClassVar[str | None] = None  # the key of a report that has its position, if any

    @property
    def kind_name(self) -> str:
        """The name of its kind."""
        raise NotImplementedError

    @property
    def joints(self) -> tuple[Any, ...]:
        """The joints whose values are its position; none where it is elsewhere than at such values."""
        return ()

    @property
    def floor_grid(self) -> Any:
        """The grid of nodes that it drives over; None for one that goes to other positions, or nowhere."""
        return None

    @property
    def goes(self) -> bool:
        """True where it goes from place to place."""
        return self.position_key is not None

    @property
    def pace(self) -> float:
        """The share of its model's speed at which it moves."""
        return 1.0 if self.driver is None else self.driver.pace

    @property
    def verb_names(self) -> tuple[str, ...]:
        """The names of its verbs, besides those for going and holding."""
        return ()

    @property
    def calls(self) -> Mapping[str, Callable[..., Command]]:
        """Makers of its verbs' commands, called with `id=`, by words: a verb and a value for each parameter,
        of a number its first value and its limits.
        """
        return {}

    @property
    def fact_names(self) -> tuple[str, ...]:
        """The facts that it reports, in the order in which people read them."""
        return () if self.driver is None else self.driver.facts

    def drawn(self) -> dict[str, object] | None:
        """Its place on the floor, its speeds and its reference, for drawings; None where it is not drawn."""
        return None

    @property
    def held_fact(self) -> str | None:
        """The fact, a yes or no, that says whether it holds something; None where it cannot hold anything."""
        return None

    @property
    def is_person(self) -> bool:
        """True for a person, who answers on the plant's own screens."""
        return self.link is Link.SCREEN

    @property
    def has_effector(self) -> bool:
        """True where it holds parts with an effector; of any other device the fact has a name."""
        return self.held_fact == "effector"

    @cached_property
    def joint_states(self) -> JointStates:
        """Its joints on ROS 2."""
        return JointStates(twin=self.name)

    @property
    def units(self) -> list[str] | None:
        """The unit of each number of its position; None where that is no list of numbers."""
        return None

    def objection(self, report: Report) -> str | None:
        """The reason why the robot cannot have said this; None where it can."""
        return None

    @property
    def works(self) -> bool:
        """True where it can be given work; a device that only answers or switches always stands still."""
        return True

    @property
    def homes(self) -> bool:
        """True where it can lose its position, and run a homing routine or be put at its reference."""
        return True

    @property
    def reference(self) -> Position | None:
        """The origin of its position; None where it counts nothing that a boot could lose."""
        return None

    @cached_property
    def motion(self) -> Movement:
        """Its ways, their times, and which positions count as one."""
        return Movement()

    def go(self, *, id: str, way: Sequence[Position]) -> Command:
        """The command that brings it along `way` to its last position."""
        raise NotImplementedError

    def verb_command(self, verb: str, values: Facts, *, id: str) -> Command:
        """The command of one of its verbs; ArboledaError for a verb or a value that it does not have."""
        raise ArboledaError(f"{self.name} has no verb {verb}")

    def grip(self, *, id: str) -> Command:
        """The command that takes hold of a part."""
        raise NotImplementedError

    def let_go(self, *, id: str) -> Command:
        """The command that lets go of what it holds."""
        raise NotImplementedError

    def at_rate(self, rate: float) -> Robot:
        """The same robot, virtual and so many times as fast."""
        return self

    @property
    def says_homed(self) -> bool:
        """True where it knows itself if it is homed; a board that assumes so after every boot does not.

        What has no homing never loses a position, and so never has to say it.
        """
        return (self.evidence is Evidence.IDS and not self.assume_homed) or not self.homes


def is_homed_by_word(robot: Robot) -> bool:
    """True where only a person can say that a robot is homed, and its driver takes that word."""
    return robot.driver is not None and robot.driver.home_is_claim


@dataclass(frozen=True, kw_only=True)
class Pose:
    """A named position of a robot; `above` the point over it where it has an approach height, `zones` where
    it lies.
    """

    name: str
    q: Position
    above: Position | None = None
    zones: frozenset[str] = frozenset()
    title: Sentence = NOTHING

    @property
    def joints(self) -> tuple[float, ...]:
        """The position of an arm."""
        assert isinstance(self.q, tuple)
        return self.q

    @property
    def sentence(self) -> Sentence:
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
    """A coded way of a robot over its grid, node by node."""

    code: str
    nodes: tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Handover:
    """Targets at which one robot of a cell, the `taker`, takes the parts that another, the `giver`, brings.

    Both robots go by their names. `by_path` has the targets of the giver's paths by code; `otherwise` is the
    target after all other paths.
    """

    taker: str
    giver: str
    otherwise: str
    by_path: tuple[tuple[str, str], ...] = ()

    @property
    def targets(self) -> tuple[str, ...]:
        """The targets, each once; `otherwise` comes first."""
        return tuple(dict.fromkeys((self.otherwise, *(target for _, target in self.by_path))))

    def after(self, code: str) -> str:
        """The target at which the taker meets a giver that has come on this path."""
        return dict(self.by_path).get(code, self.otherwise)


@dataclass(frozen=True, kw_only=True)
class Retry:
    """Retries of a failed step, where that can help: how many, and the pause before each, s."""

    times: int = 0
    backoff_s: float = 1.0


@dataclass(frozen=True, kw_only=True)
class Workspace:
    """Places of one robot in its cell, the shared zones on its ways, and what it takes parts with.

    `target_names` are pairs of a target, as recipes name it, and the name of its pose; without them each pose
    is a target of its own name. `supplies` are the names of the poses where parts lie ready for a virtual
    robot; without them all poses are.
    """

    robot: Robot
    tool: Robot | None = None  # a device of its own at the robot's end; None: what the robot itself has
    home: Pose  # where it waits
    returns: bool = True  # a recovery brings it home
    poses: tuple[Pose, ...]  # home is one of them
    target_names: tuple[tuple[str, str], ...] = ()
    supplies: tuple[str, ...] = ()
    paths: tuple[Path, ...] = ()
    crossings: tuple[Crossing, ...] = ()

    @cached_property
    def by_name(self) -> dict[str, Pose]:
        """The poses by their names."""
        return {pose.name: pose for pose in self.poses}

    @cached_property
    def targets(self) -> dict[str, Pose]:
        """The poses by the names that recipes and tasks have for them."""
        named = {target: self.by_name[pose] for target, pose in self.target_names}
        return named or self.by_name

    def at(self, targets: Iterable[str]) -> tuple[Pose, ...]:
        """The poses of these targets, each once."""
        return tuple(dict.fromkeys(self.targets[target] for target in targets))

    def path(self, code: str) -> Path:
        """The path with this code."""
        return next(path for path in self.paths if path.code == code)

    @cached_property
    def zones(self) -> frozenset[str]:
        """Every shared zone that it may get into."""
        places = (pose.zones for pose in self.poses)
        return frozenset[str]().union(*places, *(crossing.zones for crossing in self.crossings))

    def with_robots(self, change: Callable[[Robot], Robot]) -> Workspace:
        """The same workspace of a changed robot."""
        tool = None if self.tool is None else change(self.tool)
        return replace(self, robot=change(self.robot), tool=tool)

    @property
    def hand(self) -> Robot:
        """The device that holds the parts which it carries."""
        return self.tool or self.robot

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
        held_at = self.robot.motion.held_at
        return tuple((held_at(q), pose) for q, pose in spots)


@dataclass(frozen=True, kw_only=True)
class Interlock:
    """A zone that a device occupies whenever it does not say all of `free_while`, a mill whose door is not
    open, a lift that is not down; and while it carries out one of the verbs `held_while`.
    """

    device: str
    zone: str
    free_while: Facts = ()
    held_while: frozenset[str] = frozenset()

    def is_ended_by(self, command: Command) -> bool:
        """True where a command may make the device occupy the zone."""
        free = dict(self.free_while)
        return command.word in self.held_while or any(
            free.get(name, value) != value for name, value in command.sets
        )


@dataclass(frozen=True, kw_only=True)
class Place:
    """A target where parts lie, at most `holds` of them.

    `device`: the device of the cell in or under which it is. A `supply` is kept full by people, an `output`
    emptied by them: so they are when a task begins.
    """

    target: str
    holds: int = 1
    device: str | None = None
    supply: bool = False
    output: bool = False

    @cached_property
    def by_people(self) -> bool:
        """True where people keep it as tasks need it."""
        return self.supply or self.output


@dataclass(frozen=True, kw_only=True)
class Need:
    """A fact of another device of the cell without which a device is not told a verb.

    `device` and `other` are names of devices, `word` that of the verb: of a robot that goes also "go", "grip"
    and "let_go".
    """

    device: str
    word: str
    other: str
    fact: str
    value: Value


@dataclass(frozen=True, kw_only=True)
class Teach:
    """Manual mode of a cell: its low speed in rad/s and m/s, after how many s without a touch it ends."""

    turn: float = math.radians(10.0)
    slide: float = 0.025
    ends_after_s: float = 300.0


@dataclass(frozen=True, kw_only=True)
class Cell:
    """Robots and other devices that carry out one task at a time, each in a role of its own."""

    name: str
    members: tuple[tuple[str, Robot], ...] = ()  # by role
    spaces: tuple[Workspace, ...] = ()  # of those that go from pose to pose
    handover: Handover | None = None
    queue_limit: int
    goes_on: bool = False  # after a restart the queue of an idle cell goes on by itself
    goes_on_after_absence: bool = False  # what was at work, too, once its devices prove what they did
    retry: Retry = Retry()
    piece_check: PieceCheck = "auto"  # of tours that say nothing else
    drive_to_start: bool = True  # False: a robot known to be elsewhere than its path begins fails the task
    zone_wait_s: float = 30.0
    recipes: tuple[Recipe, ...] = ()
    interlocks: tuple[Interlock, ...] = ()
    needs: tuple[Need, ...] = ()
    places: tuple[Place, ...] = ()
    arrays: tuple[tuple[str, tuple[str, ...]], ...] = ()  # groups of targets by name, in order
    grids: tuple[tuple[str, int, int], ...] = ()  # of those that are made of corners: rows and columns
    shared: tuple[str, ...] = ()  # the names of those devices that other cells have, too
    teach: Teach = Teach()

    @cached_property
    def roles(self) -> dict[str, Robot]:
        """Its robots by what they are in it, in the order of the file."""
        return dict(self.members)

    @cached_property
    def reach(self) -> dict[str, Workspace]:
        """The workspaces, by the name of each robot that goes from pose to pose."""
        return {space.robot.name: space for space in self.spaces}

    @cached_property
    def taker(self) -> Workspace:
        """The workspace of the robot that takes what another one brings; the cell has a handover."""
        assert self.handover is not None
        return self.reach[self.handover.taker]

    @cached_property
    def giver(self) -> Workspace:
        """The workspace of the robot that brings it."""
        assert self.handover is not None
        return self.reach[self.handover.giver]

    @cached_property
    def workspaces(self) -> dict[str, Workspace]:
        """Those of the robots that a recovery brings home."""
        return {space.robot.name: space for space in self.spaces if space.returns}

    @cached_property
    def targets(self) -> tuple[str, ...]:
        """The names of the places that one of its robots goes to; a place has one name for all of them."""
        return tuple(dict.fromkeys(name for space in self.spaces for name in space.targets))

    @cached_property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """Targets that are chosen from together, by the name of their group."""
        return dict(self.arrays)

    @cached_property
    def station_targets(self) -> tuple[str, ...]:
        """The targets, by number, where the taker of the handover leaves parts until people take them out."""
        return () if self.handover is None else self.groups.get(STATIONS, ())

    @cached_property
    def stations(self) -> tuple[Pose, ...]:
        """The poses of these."""
        targets = self.reach[self.handover.taker].targets if self.handover is not None else {}
        return tuple(targets[name] for name in self.station_targets)

    @cached_property
    def rack(self) -> tuple[Place, ...]:
        """The stations as places without a guard: a part may come before a person has taken the last one."""
        declared = {place.target for place in self.places}
        return tuple(Place(target=name) for name in self.station_targets if name not in declared)

    @cached_property
    def counted(self) -> tuple[Place, ...]:
        """The places of which there are books."""
        return (*self.places, *self.rack)

    @cached_property
    def paths(self) -> dict[str, Path]:
        """The paths of its robots by code."""
        return {path.code: path for space in self.spaces for path in space.paths}

    def recipe(self, name: str) -> Recipe:
        """The recipe of this name; ArboledaError where the cell has none."""
        for recipe in self.recipes:
            if recipe.name == name:
                return recipe
        raise ArboledaError(f"{name} is not a recipe of {self.name}")

    def back(self, robot: str, positions: Positions) -> Pose | None:
        """The pose to which a recovery brings a part whose origin nobody knows; None: the robot keeps it."""
        if self.handover is None or robot != self.handover.taker:
            return None
        return self.pickup_over(positions(self.handover.giver))

    def pickup_over(self, position: Position | None) -> Pose:
        """The pose at which the taker meets a giver that stands there, by the first path with this end."""
        assert self.handover is not None
        ends = (path.code for path in self.reach[self.handover.giver].paths if path.nodes[-1] == position)
        return self.reach[self.handover.taker].targets[self.handover.after(next(ends, ""))]

    @cached_property
    def robots(self) -> tuple[Robot, ...]:
        return tuple(self.roles.values())

    def with_robots(self, change: Callable[[Robot], Robot]) -> Cell:
        """The same cell with each robot changed; none of them gets another name."""
        members = tuple((role, change(robot)) for role, robot in self.members)
        return replace(
            self, members=members, spaces=tuple(space.with_robots(change) for space in self.spaces)
        )

    @cached_property
    def reached(self) -> tuple[Robot, ...]:
        """Its robots without those that are only drawn."""
        return tuple(robot for robot in self.robots if robot.link is not Link.NONE)

    @cached_property
    def holders(self) -> tuple[str, ...]:
        """The robots that can hold a part."""
        return tuple(robot.name for robot in self.robots if robot.held_fact is not None)

    def interlocks_of(self, device: str) -> tuple[Interlock, ...]:
        """Those of one device."""
        return tuple(each for each in self.interlocks if each.device == device)

    @cached_property
    def own(self) -> tuple[str, ...]:
        """The names of its robots that no other cell has."""
        return tuple(robot.name for robot in self.robots if robot.name not in self.shared)

    @cached_property
    def shared_movers(self) -> tuple[str, ...]:
        """Those that it shares and that go from place to place."""
        return tuple(name for name in self.shared if name in self.reach)

    def together(self, shared: Iterable[str]) -> frozenset[str]:
        """These shared devices with what is only held with them: a robot's tool, and the robot of a tool."""
        names = set(shared)
        for space in self.spaces:
            if space.tool is not None and not names.isdisjoint((space.robot.name, space.tool.name)):
                names |= {space.robot.name, space.tool.name}
        return frozenset(names)

    @cached_property
    def interlocked(self) -> tuple[str, ...]:
        """The devices that may occupy shared zones."""
        return tuple(dict.fromkeys(each.device for each in self.interlocks))

    @cached_property
    def zone_users(self) -> tuple[str, ...]:
        """The robots that may get into shared zones."""
        return tuple(name for name, workspace in self.workspaces.items() if workspace.zones)


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
class OpcUaView:
    """Port of the server of OPC UA that shows the plant, and the ISA-95 levels that the plant is in."""

    port: int = 4840
    isa95: tuple[str, ...] = ()  # enterprise, site, area, work center; as many as are given


@dataclass(frozen=True, kw_only=True)
class PlantModel:
    """The whole plant as its file describes it."""

    name: str
    cells: tuple[Cell, ...]
    timing: Timing = Timing()
    mqtt_version: MqttVersion = MqttVersion.V3_1_1
    zones: tuple[str, ...] = ()
    foreign_commands: ForeignCommands = ForeignCommands.REFUSE
    history_days: float = 90.0  # how long ended tasks are kept
    groot2_port: int | None = None  # where the first cell's tree is shown to Groot2
    opcua_view: OpcUaView | None = None  # the plant as a server of OPC UA; None: off
    store: str = ""  # the database where its memory is, "": in a file of its own
    assistants: Assistants = Assistants.OFF
    assistant_limits: AssistantLimits = NO_LIMITS
    extensions: Mapping[str, object] = field(default_factory=dict, hash=False)  # settings, by package
    extensions_off: frozenset[str] = frozenset()  # the packages that it leaves out
    brought: Mapping[str, Mapping[str, str]] = field(default_factory=dict, compare=False)  # by packages

    def cell(self, name: str) -> Cell:
        return next(cell for cell in self.cells if cell.name == name)

    def on_boards(self, *links: Link) -> PlantModel:
        """The same plant, where who is reached by one of these has a board on MQTT instead."""

        def change(robot: Robot) -> Robot:
            return replace(robot, link=Link.MQTT, driver=None) if robot.link in links else robot

        return replace(self, cells=tuple(cell.with_robots(change) for cell in self.cells))

    @cached_property
    def robots(self) -> dict[str, Robot]:
        """Every robot by name, in the order of the file."""
        return {robot.name: robot for cell in self.cells for robot in cell.robots}

    @cached_property
    def recipes(self) -> tuple[Recipe, ...]:
        """Every recipe that a cell of it has, the default ones first."""
        recipes = dict.fromkeys(each for cell in self.cells for each in cell.recipes)
        return tuple(sorted(recipes, key=lambda each: not each.is_default))

    @cached_property
    def has_boards(self) -> bool:
        """True where a robot is reached over MQTT; without one, nobody needs a broker."""
        return any(robot.link is Link.MQTT for robot in self.robots.values())

    @cached_property
    def cells_of(self) -> dict[str, tuple[Cell, ...]]:
        """The cells of each robot by its name, in the order of the file; only what is shared has several."""
        cells_of: dict[str, tuple[Cell, ...]] = {}
        for cell in self.cells:
            for robot in cell.robots:
                cells_of[robot.name] = (*cells_of.get(robot.name, ()), cell)
        return cells_of

    @cached_property
    def driven(self) -> tuple[Robot, ...]:
        """Its robots that drivers of somebody's own reach."""
        return tuple(robot for robot in self.robots.values() if robot.link is Link.DRIVER)

    @cached_property
    def cell_of(self) -> dict[str, Cell]:
        """The cell of each robot, by robot name; of what is shared the first one."""
        return {name: cells[0] for name, cells in self.cells_of.items()}

    @cached_property
    def shared(self) -> tuple[str, ...]:
        """The devices that cells share, each held by one of them at a time."""
        return tuple(dict.fromkeys(name for cell in self.cells for name in cell.shared))
