"""The robot models of `arboleda_description/robots/*.yaml`, in SI units."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from arboleda.kinds.joints import Description, Joint

from .document import Document, Place, choice

Number = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(ge=0, le=1)]
Triple = Annotated[list[Number], Field(min_length=3, max_length=3)]
Color = Annotated[list[Share], Field(min_length=4, max_length=4)]
Pair = Annotated[list[Number], Field(min_length=2, max_length=2)]


@dataclass(frozen=True, kw_only=True)
class ArmModel:
    """A model of arm: its joints from the base outwards; `description` if it is the plant's own."""

    name: str
    joints: tuple[Joint, ...]
    description: Description | None = None


@dataclass(frozen=True, kw_only=True)
class MobileModel:
    """A model of mobile robot; `speed` in m/s."""

    name: str
    speed: float


def millimetres(value: float) -> float:
    """mm -> m."""
    return value / 1000


FULL_TURN_RAD = 2 * math.pi  # either way, for a joint without ends
PINION_MM = math.degrees(1.0)  # a pinion that moves its rack by 1 mm per degree

TO_SI: dict[str, Callable[[float], float]] = {"deg": math.radians, "rad": float, "mm": millimetres}


class Shape(BaseModel):
    """A mapping of known keys; text is no number and a number no text."""

    # Built when it is used first: a plant file needs few of all shapes.
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, defer_build=True)


class RobotFile(Shape):
    """The file of a robot: its name, its joints, and the data for its drawing and its reader."""

    model: str
    joints: list[Any]
    sources: dict[str, str]
    sizes_mm: dict[str, list[Positive]] = {}
    colors_rgba: dict[str, Color] = {}


class ArmFile(RobotFile):
    """`kind: arm`; `links_m` and `link_masses_kg` are for the drawing."""

    kind: Literal["arm"]
    links_m: list[Positive] = []
    link_masses_kg: list[Positive] = []


class MobileFile(RobotFile):
    """`kind: mobile`; its joints and its mass are for the drawing."""

    kind: Literal["mobile"]
    speed_mm_s: Positive
    mass_kg: Positive


class SlideFile(Shape):
    """One joint of a mobile robot, as its drawing needs it."""

    name: str
    type: Literal["prismatic"]
    axis: Triple
    limits_mm: Pair
    effort_n: Positive


class JointFile(Shape):
    """One joint; limits and speed are in the unit of their source, `step_deg` is of motor or pinion."""

    name: str
    type: Literal["revolute", "continuous", "prismatic"]
    step_deg: Positive
    pinion_radius_mm: Positive = PINION_MM
    limits_deg: Pair = []
    limits_rad: Pair = []
    limits_mm: Pair = []
    speed_deg_s: Positive = 0.0
    speed_rad_s: Positive = 0.0
    speed_mm_s: Positive = 0.0
    acceleration_deg_s2: Positive = 0.0
    acceleration_mm_s2: Positive = 0.0
    effort_n_m: Positive = 0.0
    effort_n: Positive = 0.0
    axis: Triple = []
    origin_xyz_m: Triple = []
    origin_rpy_rad: Triple = []


@cache
def arm_models() -> dict[str, ArmModel]:
    """Every arm of these files by the name of its model; ConfigError if a file is damaged."""
    return {name: _arm(document) for name, document in _documents("arm").items()}


@cache
def mobile_models() -> dict[str, MobileModel]:
    """Every mobile robot of these files by the name of its model; ConfigError if a file is damaged."""
    return {name: _mobile(document) for name, document in _documents("mobile").items()}


def pose_at_home(kind: str, model: object) -> dict[str, Any] | None:
    """The pose at home, all joints at 0, as a plant file has it; None for other models."""
    if kind == "mobile":
        return {"node": 0}
    arm = arm_models().get(model) if kind == "arm" and isinstance(model, str) else None
    if arm is None:
        return None
    slides = sum(each.pinion_radius_m is not None for each in arm.joints)
    pose: dict[str, Any] = {"deg": [0] * (len(arm.joints) - slides)}
    return pose if not slides else pose | {"mm": 0 if slides == 1 else [0] * slides}


def _documents(kind: str) -> dict[str, Document]:
    robots = sorted(files("arboleda_description").joinpath("robots").iterdir(), key=lambda entry: entry.name)
    documents = [
        Document(f"robots/{entry.name}", entry.read_bytes())
        for entry in robots
        if entry.name.endswith(".yaml")
    ]
    return {
        document.value(("model",)): document for document in documents if document.value(("kind",)) == kind
    }


def _arm(document: Document) -> ArmModel:
    shape = document.read(ArmFile)
    places: list[Place] = [("joints", index) for index in range(len(shape.joints))] if shape else []
    joints = [described_joint(document, place) for place in places]
    document.finish()
    return ArmModel(name=document.value(("model",)), joints=tuple(joint for joint in joints if joint))


def _mobile(document: Document) -> MobileModel:
    shape = document.read(MobileFile)
    for index in range(len(shape.joints) if shape else 0):
        document.read(SlideFile, ("joints", index))
    document.finish()
    return MobileModel(name=document.value(("model",)), speed=millimetres(shape.speed_mm_s if shape else 0.0))


def described_joint(document: Document, place: Place) -> Joint | None:
    """One entry of `joints`; None, with its problems kept, if something is wrong with it."""
    shape = document.read(JointFile, place)
    if shape is None:
        return None
    units = ("mm",) if shape.type == "prismatic" else ("deg", "rad")
    limits = _limits(document, place, shape, units)
    speed = _quantity(document, place, "speed_{}_s", units)
    acceleration = _quantity(document, place, "acceleration_{}_s2", units[:1])
    if not (limits and speed and acceleration):
        return None
    pinion = millimetres(shape.pinion_radius_mm) if shape.type == "prismatic" else None
    step = math.radians(shape.step_deg) * (1.0 if pinion is None else pinion)
    return Joint(
        name=shape.name,
        lower=limits[0],
        upper=limits[1],
        speed=speed[0],
        acceleration=acceleration[0],
        step=step,
        pinion_radius_m=pinion,
    )


def _limits(document: Document, place: Place, shape: JointFile, units: tuple[str, ...]) -> tuple[float, ...]:
    """Both ends of a joint; empty, with the problem kept, if they are impossible."""
    if shape.type == "continuous":
        for key in ("limits_deg", "limits_rad", "limits_mm"):
            if document.has((*place, key)):
                document.problem(
                    (*place, key), "a continuous joint has no ends; write revolute, or delete it"
                )
        return (-FULL_TURN_RAD, FULL_TURN_RAD)
    limits = _quantity(document, place, "limits_{}", units)
    if limits and not (limits[0] <= 0 <= limits[1] and limits[0] < limits[1]):
        key = next(key for unit in units if document.has((*place, key := f"limits_{unit}")))
        document.problem((*place, key), "must be lower, then upper, with 0 inside, where homing ends")
        return ()
    return limits


def _quantity(document: Document, place: Place, key: str, units: tuple[str, ...]) -> tuple[float, ...]:
    """The numbers of a quantity in SI units; empty, with the problem kept, unless one unit's key is there."""
    keys = {key.format(unit): TO_SI[unit] for unit in units}
    present = [name for name in keys if document.has((*place, name))]
    if len(present) != 1:
        document.problem(place, f"needs {choice(keys)}, one of them")
        return ()
    value = document.value((*place, present[0]))
    return tuple(keys[present[0]](each) for each in (value if isinstance(value, list) else [value]))
