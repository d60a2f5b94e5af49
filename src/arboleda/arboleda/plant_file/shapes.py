"""The mappings a plant file is made of: keys, types, ranges, defaults."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, TypeAdapter
from pydantic_core import PydanticCustomError

from arboleda.kinds.declared import Effect
from arboleda.model.assistants import AssistantLimits, hours
from arboleda.model.commands import OnStop
from arboleda.model.plant_model import Cell, Evidence, OpcUaView, PlantModel, Retry, Teach, Timing
from arboleda.model.recording import Limits

from .robot_models import Number, Pair, Positive, Shape, Triple

DAY_S = 86400
NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*_?", re.ASCII)
NAME_RULE = "a name of at most 64 small letters, digits and single underscores, the first a letter"
PLANT_NAME = re.compile(r"[a-z][a-z0-9_-]*", re.ASCII)
PLANT_NAME_RULE = "a name of at most 64 small letters, digits, - and _, the first a letter"


def is_name(text: str) -> bool:
    """True if ROS 2 and MQTT both take `text` as one level of a topic."""
    return len(text) <= 64 and NAME.fullmatch(text) is not None


def _name(text: str) -> str:
    if not is_name(text):
        raise PydanticCustomError("name", "must be " + NAME_RULE)
    return text


def is_plant_name(text: str) -> bool:
    """True if a plant can have this name."""
    return len(text) <= 64 and PLANT_NAME.fullmatch(text) is not None


def _plant_name(text: str) -> str:
    if not is_plant_name(text):
        raise PydanticCustomError("name", "must be " + PLANT_NAME_RULE)
    return text


def _protocol(value: Any) -> Any:
    """The version of the protocol: `5` and `"5"` are the same one; `5.0` and `true` are none."""
    return "5" if type(value) is int and value == 5 else value


def _hours(text: str) -> str:
    try:
        return hours(text).text
    except ValueError:
        raise PydanticCustomError("hours", 'must be hours of a day such as "07:30-18:00"') from None


def _piece_check(value: Any) -> Any:
    if value != "auto" and not isinstance(value, bool):
        raise PydanticCustomError("piece_check", "must be auto, true or false")
    return value


Name = Annotated[str, AfterValidator(_name)]
Duration = Annotated[float, Field(gt=0, le=DAY_S, allow_inf_nan=False)]
Wait = Annotated[float, Field(ge=0, le=DAY_S, allow_inf_nan=False)]
Speed = Annotated[float, Field(ge=0.1, allow_inf_nan=False)]
Reach = Literal["mqtt", "ros", "none"]
QUEUE_LIMIT = 100
NO_PORT = 0  # of a file that names none
QueueLimit = Annotated[int, Field(ge=1, le=10_000)]
OnRestart = Literal["hold", "go_on"]
OnAbsence = Literal["hold", "go_on"]
Angles = Annotated[list[Number], Field(min_length=1, max_length=9)]


class PlantShape(Shape):
    """The plant in its file; `paths`, `stations` and `palletizing` here serve every cell without its own."""

    name: Annotated[str, AfterValidator(_plant_name)]
    uses: Any = None
    kinds: Any = None
    shared: Any = None
    cells: Annotated[dict[str, Any], Field(min_length=1)]
    timing: Any = None
    mqtt_version: Annotated[Literal["3.1.1", "5"], BeforeValidator(_protocol)] = "3.1.1"
    foreign_commands: Literal["refuse", "obey"] = "refuse"
    history_days: Annotated[float, Field(gt=0, le=36_500, allow_inf_nan=False)] = PlantModel.history_days
    groot2: Annotated[int, Field(ge=1, le=65_534)] = NO_PORT
    opcua_view: Any = None
    extensions: Any = None
    store: str = ""
    assistants: Literal["off", "read", "propose", "submit"] = "off"
    assistant_limits: Any = None
    paths: Any = None
    stations: Any = None
    palletizing: Any = None
    zones: Any = None


class FileShape(PlantShape):
    """The whole file: the plant, and the limits of its record."""

    record: Any = None
    reports: Literal["on", "off"] = "off"


class RecordShape(Shape):
    """`record:`, the limits of the flight record."""

    megabytes: Annotated[float, Field(ge=2, le=1_000_000, allow_inf_nan=False)] = Limits.megabytes
    days: Annotated[float, Field(gt=0, le=36_500, allow_inf_nan=False)] = Limits.days


class OpcUaViewShape(Shape):
    """`opcua_view:`, the server of OPC UA that shows the plant."""

    port: Annotated[int, Field(ge=1, le=65_535)] = OpcUaView.port
    isa95: Annotated[list[Name], Field(max_length=4)] = Field(default_factory=list)


class AssistantLimitsShape(Shape):
    """`assistant_limits:`, the limits of the tasks that assistants give."""

    cells: Annotated[list[str], Field(min_length=1, max_length=1000)]
    at_once: Annotated[int, Field(ge=1, le=1000)] = AssistantLimits.at_once
    hours: Annotated[str, AfterValidator(_hours)] | None = None


class TimingShape(Shape):
    """`timing:`; the defaults are those of core.model.Timing."""

    dwell_s: Wait = Timing.dwell_s
    effector_settle_s: Wait = Timing.effector_settle_s
    effector_timeout_s: Duration = Timing.effector_timeout_s
    stale_after_s: Annotated[float, Field(ge=0.3, le=DAY_S, allow_inf_nan=False)] = Timing.stale_after_s
    stop_timeout_s: Duration = Timing.stop_timeout_s
    deadline_factor: Annotated[float, Field(ge=1, le=100, allow_inf_nan=False)] = Timing.deadline_factor
    deadline_floor_s: Duration = Timing.deadline_floor_s
    piece_wait_s: Duration = Timing.piece_wait_s
    piece_debounce_s: Wait = Timing.piece_debounce_s


ROBOT_KEYS = TAKER_KEY, GIVER_KEY = "arm", "mobile"
"""The keys of the two robots of a cell in the short form."""


class AnyCellShape(Shape):
    """The keys that a cell of either form has; its name is its key under `cells:`."""

    queue_limit: QueueLimit = QUEUE_LIMIT
    on_restart: OnRestart = "hold"
    on_absence: OnAbsence = "hold"
    drive_to_start: bool = True
    retry: Any = None
    teach: Any = None
    piece_check: Annotated[Any, AfterValidator(_piece_check)] = Cell.piece_check
    zone_wait_s: Duration = Cell.zone_wait_s


class CellShape(AnyCellShape):
    """One cell in the short form: an arm and a mobile robot that store parts."""

    arm: Any
    mobile: Any
    home: Any
    pickup: Any = None
    pickups: Any = None
    paths: Any = None
    stations: Any = None
    palletizing: Any = None


class DeviceCellShape(AnyCellShape):
    """One cell of devices by role; without `recipes` it offers all that fit."""

    devices: Annotated[dict[str, Any], Field(min_length=1)]
    recipes: Annotated[list[str], Field(min_length=1)] = Field(default_factory=list)
    default_recipe: str = ""
    targets: Any = None
    groups: Any = None
    paths: Any = None
    handover: Any = None
    needs: Any = None
    places: Any = None


class HandoverShape(Shape):
    """`handover:`, two roles and the targets at which one robot takes parts from the other."""

    taker: str
    giver: str
    at: str
    by_path: dict[str, str] = Field(default_factory=dict)


class PlaceShape(Shape):
    """One row of `places:`; `of` is the role of the device in or under which the place is."""

    holds: Annotated[int, Field(ge=1, le=10_000)] = 1
    of: str = ""
    supply: bool = False
    output: bool = False


class KindShape(Shape):
    """One kind of devices; its name is its key under `kinds:`."""

    facts: Any = None
    verbs: dict[str, Any] = Field(default_factory=dict)


class VerbShape(Shape):
    """One verb of a kind; an `at_most_s` of 0 is one by `takes_s`."""

    effect: Annotated[Effect, Field(strict=False)]
    with_: Any = Field(default=None, alias="with")
    sets: Any = None
    needs: Any = None
    takes_s: Wait = 0.0
    at_most_s: Duration = 0.0
    on_stop: Annotated[OnStop, Field(strict=False)] = OnStop.HALT
    holds: Literal["part"] = "part"
    works_on: Literal["part"] = "part"
    makes: Literal["part"] = "part"
    answers: Any = None


class DeviceShape(Shape):
    """One device of a cell, in the role that is its key; an empty `name` is the role, `mqtt` the name.

    A `link` is the short form of a `driver` that comes with Arboleda.
    """

    kind: str
    name: Name = ""
    mqtt: Name = ""
    link: Literal["mqtt", "ros"] = "mqtt"
    driver: Any = None
    evidence: Literal["ids", "facts", "joints", "state"] = "ids"
    stop: Literal["supported", "none"] = "supported"
    tool_of: str = ""


class SharedRoleShape(Shape):
    """A device that several cells have, in its role in one of them."""

    shared: str


class RetryShape(Shape):
    """`retry:`; the defaults are those of core.model.Retry."""

    times: Annotated[int, Field(ge=0, le=10)] = Retry.times
    backoff_s: Wait = Retry.backoff_s


class TeachShape(Shape):
    """`teach:`, the manual mode of a cell; the defaults are those of core.model.Teach, its limits what people
    can follow with their eyes.
    """

    deg_s: Annotated[float, Field(gt=0, le=30, allow_inf_nan=False)] = 10.0
    mm_s: Annotated[float, Field(gt=0, le=250, allow_inf_nan=False)] = 25.0
    ends_after_s: Annotated[float, Field(ge=10, le=3600, allow_inf_nan=False)] = Teach.ends_after_s

    @property
    def teach(self) -> Teach:
        """The same in SI units."""
        turn, slide = math.radians(self.deg_s), self.mm_s / 1000
        return Teach(turn=turn, slide=slide, ends_after_s=self.ends_after_s)


class RobotShape(Shape):
    """The keys that an arm and a mobile robot have in common; an empty `mqtt` is the robot's own name.

    A `link` is the short form of a `driver` that comes with Arboleda.
    """

    name: Name
    mqtt: Name = ""
    link: Reach
    driver: Any = None
    evidence: Annotated[Evidence, Field(strict=False)]
    assume_homed: bool = False
    home_at_start: bool = False
    stop: Literal["supported", "none"] = "supported"


class ArmShape(RobotShape):
    """`arm:`; an empty `twin` is the arm's own name, a `model` the name of one, a file or a ModelShape."""

    model: Any
    twin: Name = ""
    base: Any = None
    timeout_s: Duration = 10.0
    limits: Any = None
    speeds: Any = None
    tolerance: Any = None
    piece_on_change: bool = False
    trigger_when_busy: Literal["queue", "refuse"] = "queue"


class OffsetShape(Shape):
    """The offset of one frame in another: shifted, and turned about x, then y, then z."""

    xyz_mm: Triple = Field(default_factory=lambda: [0.0, 0.0, 0.0])
    rpy_deg: Triple = Field(default_factory=lambda: [0.0, 0.0, 0.0])


class ModelShape(Shape):
    """`model:` of an arm that gives more than the name of its own file."""

    file: str
    base_link: str | None = None
    tip_link: str | None = None
    mount: Any = None
    tool: Any = None
    accelerations: Any = None
    steps: Any = None


class DrivenArmShape(ArmShape):
    """An arm that needs no link, as it has a driver."""

    link: Reach = "mqtt"


class ArmDeviceShape(DrivenArmShape):
    """An arm in a role; an empty `name` is the role."""

    kind: str
    name: Name = ""
    evidence: Annotated[Evidence, Field(strict=False)] = Evidence.IDS


class MobileShape(RobotShape):
    """`mobile:`; without `speed_mm_s` it drives at the model's speed."""

    model: str = "mobile"
    grid: Any = None
    timeout_s: Duration = 20.0
    speed_mm_s: Speed = 0.0


class DrivenMobileShape(MobileShape):
    """A mobile robot that needs no link, as it has a driver."""

    link: Reach = "mqtt"


class MobileDeviceShape(DrivenMobileShape):
    """A mobile robot in a role; an empty `name` is the role."""

    kind: str
    name: Name = ""
    evidence: Annotated[Evidence, Field(strict=False)] = Evidence.IDS


class MovingDeviceShape(RobotShape):
    """A robot of a kind of one's own, in a role; an empty `name` is the role."""

    kind: str
    name: Name = ""
    link: Reach = "mqtt"
    evidence: Annotated[Evidence, Field(strict=False)] = Evidence.IDS
    timeout_s: Duration = 10.0


class PersonShape(Shape):
    """A person in a role; an empty `name` is the role."""

    kind: str
    name: Name = ""


class NodeShape(Shape):
    """The node at which a mobile robot stands for a target."""

    node: Annotated[int, Field(ge=0)]


class ArrayShape(Shape):
    """A group of targets by its corners, of each robot that goes there."""

    grid: Annotated[list[Annotated[int, Field(ge=1, le=100)]], Field(min_length=2, max_length=2)]
    corners: Annotated[dict[str, Any], Field(min_length=1)]


class BaseShape(Shape):
    """`base:`, the place of an arm in the `world` frame."""

    origin_m: Pair = Field(default_factory=lambda: [0.0, 0.0])
    yaw_deg: Number = 0.0


class GridShape(BaseShape):
    """`grid:`, the place of node 0; columns go along x and rows along y of the turned frame."""

    pitch_mm: Annotated[float, Field(ge=1, le=10_000, allow_inf_nan=False)] = 200.0


class PositionShape(Shape):
    """Joint values from the base outwards: `deg` of the turning joints, `mm` of the sliding one or ones."""

    deg: list[Number] = Field(default_factory=list)
    mm: Any = None


class PoseShape(PositionShape):
    """A pose with an approach height; 0 is none."""

    approach_mm: Positive = 0.0


class RackShape(Shape):
    """Stations by rule: station = row x columns + column; joints the rule does not name stay as in `home`."""

    columns_q1_deg: Angles
    rows_q2_deg: Angles
    mm: Any = None
    approach_mm: Positive = 0.0


class PalletizingShape(Shape):
    """`palletizing:`, two poses of the cell by name."""

    pick: str
    place: str


class ZoneShape(Shape):
    """One zone under `zones:`; a pose is written `<cell> <pose>`, a move as its two ends.

    `free_while` has the devices that occupy it by themselves, and their facts while they do not; `held_while`
    those that occupy it while they carry out one of some verbs.
    """

    poses: list[str] = Field(default_factory=list)
    moves: list[Annotated[list[str], Field(min_length=2, max_length=2)]] = Field(default_factory=list)
    free_while: dict[str, Any] = Field(default_factory=dict)
    held_while: dict[str, Any] = Field(default_factory=dict)


STRICT = ConfigDict(strict=True, defer_build=True)
WORDS: TypeAdapter[list[str]] = TypeAdapter(Annotated[list[str], Field(min_length=1)], config=STRICT)
NODES: TypeAdapter[list[int]] = TypeAdapter(
    Annotated[list[int], Field(min_length=1, max_length=64)], config=STRICT
)
LIMITS: TypeAdapter[list[float]] = TypeAdapter(Pair, config=STRICT)
NUMBER: TypeAdapter[float] = TypeAdapter(Number, config=STRICT)
NUMBERS: TypeAdapter[list[float]] = TypeAdapter(list[Number], config=STRICT)
POSITIVE: TypeAdapter[float] = TypeAdapter(Positive, config=STRICT)
SPEED: TypeAdapter[float] = TypeAdapter(Speed, config=STRICT)
MAPPING: TypeAdapter[dict[str, Any]] = TypeAdapter(
    Annotated[dict[str, Any], Field(min_length=1)], config=STRICT
)
