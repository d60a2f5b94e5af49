"""The robots and people of a plant file, which may narrow the limits of a model and never widen them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, TypeVar

from arboleda.kinds.arm import Arm
from arboleda.kinds.floor import Placement
from arboleda.kinds.joints import Joint
from arboleda.kinds.mobile import Grid, Mobile
from arboleda.kinds.person import Person, person
from arboleda.model.plant_model import Evidence

from . import drivers
from .document import Document, Place, choice, closest, nearest, shown
from .own_models import is_own, own_model
from .poses import PoseReader, in_file_unit, span
from .robot_models import TO_SI, ArmModel, arm_models, millimetres, mobile_models
from .shapes import (
    LIMITS,
    MAPPING,
    SPEED,
    ArmDeviceShape,
    ArmShape,
    BaseShape,
    DrivenArmShape,
    DrivenMobileShape,
    GridShape,
    MobileDeviceShape,
    MobileShape,
    PersonShape,
    RobotShape,
)

T = TypeVar("T")


def arm_model(document: Document, place: Place) -> ArmModel | None:
    """The model that `arm:` names, its joints narrowed by `limits:` and `speeds:`."""
    named = (*place, "model")
    if is_own(document.value(named)):
        model = own_model(document, named)
    else:
        model = _model(document, named, arm_models(), also=("a file beside this one (models/my_arm.urdf)",))
    if model is None:
        return None
    narrowed = tuple(
        _narrowed(document, place, index, joint) for index, joint in enumerate(model.joints, start=1)
    )
    _refuse_other_keys(
        document, (*place, "limits"), [_limits_key(*each) for each in enumerate(model.joints, 1)]
    )
    _refuse_other_keys(
        document, (*place, "speeds"), [_speed_key(*each) for each in enumerate(model.joints, 1)]
    )
    return replace(model, joints=narrowed)


def arm(
    document: Document, place: Place, model: ArmModel | None, written: type[ArmShape] | None = None
) -> Arm | None:
    """The arm of a cell; None, with its problems kept, if something is wrong with it."""
    of_a_cell = DrivenArmShape if document.has((*place, drivers.KEY)) else ArmShape
    shape = document.read(written or of_a_cell, place)
    base = document.section(BaseShape, (*place, "base"))
    check_homing(document, place, shape)
    tolerance = _tolerance(document, (*place, "tolerance"), model) if model else None
    if shape is None or base is None or model is None:
        return None
    return Arm(
        **names_and_link(document, shape, place),
        model=model.name,
        twin=shape.twin or shape.name or str(place[-1]),
        base=_placement(base, is_declared=document.has((*place, "base"))),
        joints=model.joints,
        timeout_s=shape.timeout_s,
        tolerance=tolerance,
        piece_on_change=shape.piece_on_change,
        queue_triggers=shape.trigger_when_busy == "queue",
        description=model.description,
    )


def mobile(document: Document, place: Place, written: type[MobileShape] | None = None) -> Mobile | None:
    """The mobile robot of a cell; None, with its problems kept, if something is wrong with it."""
    of_a_cell = DrivenMobileShape if document.has((*place, drivers.KEY)) else MobileShape
    shape = document.read(written or of_a_cell, place)
    grid = document.section(GridShape, (*place, "grid"))
    check_homing(document, place, shape)
    model = _model(document, (*place, "model"), mobile_models(), default="mobile")
    if shape is None or grid is None or model is None:
        return None
    speed = millimetres(shape.speed_mm_s) or model.speed
    if speed > model.speed:
        fastest = f"{model.speed * 1000:g} mm/s, the speed of the model {model.name}"
        document.problem((*place, "speed_mm_s"), f"must be at most {fastest}, is {shape.speed_mm_s:g}")
    return Mobile(
        **names_and_link(document, shape, place),
        model=model.name,
        grid=Grid(
            origin=_placement(grid, is_declared=document.has((*place, "grid"))),
            pitch=millimetres(grid.pitch_mm),
        ),
        speed=speed,
        timeout_s=shape.timeout_s,
    )


def arm_device(document: Document, place: Place) -> Arm | None:
    """The arm that a cell has among its devices; None, with its problems kept, if something is wrong."""
    return arm(document, place, arm_model(document, place), ArmDeviceShape)


def mobile_device(document: Document, place: Place) -> Mobile | None:
    """The mobile robot that a cell has among its devices; None, with problems kept, if something is wrong."""
    return mobile(document, place, MobileDeviceShape)


def person_device(document: Document, place: Place) -> Person | None:
    """A person at the cell; None, with the problems kept, if something is wrong."""
    named = document.read(PersonShape, place)
    return None if named is None else person(named.name or str(place[-1]))


def check_homing(document: Document, place: Place, shape: RobotShape | None) -> None:
    """Keep a problem if a robot is to be homed at its start and that contradicts its other keys."""
    if shape is None or not shape.home_at_start:
        return
    if shape.assume_homed:
        document.problem((*place, "home_at_start"), "contradicts assume_homed: true; keep one of them")
    elif shape.evidence is not Evidence.IDS:
        needs = f"needs evidence: ids; {shape.evidence.value} cannot prove that the homing routine has ended"
        document.problem((*place, "home_at_start"), needs)


def names_and_link(document: Document, shape: RobotShape, place: Place) -> dict[str, Any]:
    """The names, link and evidence of a robot, as its class takes them."""
    name = shape.name or str(place[-1])
    return {
        "name": name,
        "mqtt": shape.mqtt or name,
        "link": drivers.link(document, place, shape.link, drivers.COME_WITH_IT),
        "evidence": shape.evidence,
        "assume_homed": shape.assume_homed,
        "home_at_start": shape.home_at_start,
        "has_stop": shape.stop == "supported",
    }


def _placement(shape: BaseShape, *, is_declared: bool) -> Placement:
    x, y = shape.origin_m
    return Placement(x=x, y=y, yaw=math.radians(shape.yaw_deg), is_declared=is_declared)


def _model(
    document: Document,
    place: Place,
    models: dict[str, T],
    default: str | None = None,
    also: tuple[str, ...] = (),
) -> T | None:
    """The model of that name; for a misspelt name, with the problem kept, the model that was probably meant.

    So the other keys can be checked against that model.
    """
    name = document.value(place) if document.has(place) else default
    if not isinstance(name, str):
        if also and document.has(place):
            document.problem(place, f"must be {choice([*sorted(models), *also])}, is {shown(name)}")
        return None
    if name not in models:
        allowed, unchecked = choice([*sorted(models), *also]), ""
        if closest(name, models) is None:
            unchecked = "; what depends on the model is checked once it is right"
        document.problem(place, f"must be {allowed}, is {shown(name)}{nearest(name, models)}{unchecked}")
    return models.get(name) or models.get(closest(name, models) or "")


def _limits_key(number: int, joint: Joint) -> str:
    return f"q{number}_{'deg' if joint.unit == 'rad' else 'mm'}"


def _speed_key(number: int, joint: Joint) -> str:
    return _limits_key(number, joint) + "_s"


def _refuse_other_keys(document: Document, place: Place, allowed: list[str]) -> None:
    if not document.has(place):
        return
    for key in document.read_plain(MAPPING, place) or ():
        if key not in allowed:
            document.unknown((*place, key), allowed)


def _narrowed(document: Document, place: Place, number: int, joint: Joint) -> Joint:
    """The joint with the file's limits and speed; unchanged, with the problem kept, if they are wrong."""
    si = TO_SI["deg" if joint.unit == "rad" else "mm"]
    limits_place = (*place, "limits", _limits_key(number, joint))
    speed_place = (*place, "speeds", _speed_key(number, joint))
    if limits := document.read_plain(LIMITS, limits_place):
        lower, upper = si(limits[0]), si(limits[1])
        if joint.lower <= lower <= 0 <= upper <= joint.upper and lower < upper:
            joint = replace(joint, lower=lower, upper=upper)
        else:
            rule = f"must lie within {span(joint)} (the model), lower first, with 0 (homed) inside"
            document.problem(limits_place, f"{rule}; is [{limits[0]:g}, {limits[1]:g}]")
    if speed := document.read_plain(SPEED, speed_place):
        if si(speed) <= joint.speed:
            return replace(joint, speed=si(speed))
        fastest = f"{in_file_unit(joint, joint.speed)}/s, the speed of the model"
        document.problem(speed_place, f"must be at most {fastest}, is {speed:g}")
    return joint


def _tolerance(document: Document, place: Place, model: ArmModel) -> tuple[float, ...] | None:
    if not document.has(place):
        return None
    tolerance = PoseReader(
        document=document, cell=str(place[1]), model=model.name, joints=model.joints
    ).position(place)
    for number, (joint, value) in enumerate(zip(model.joints, tolerance or (), strict=False), start=1):
        least = joint.step / 2 + 1e-5
        if value < least:
            rule = f"at least {in_file_unit(joint, least)}, half a motor step and a little"
            document.problem(place, f"q{number} must have {rule}, has {in_file_unit(joint, value)}")
    return tolerance
