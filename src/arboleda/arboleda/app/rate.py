"""Virtual robots that are faster or slower than the real ones."""

from __future__ import annotations

from dataclasses import replace

from arboleda.core.errors import StartError
from arboleda.core.model import Cell, PlantModel, Robot
from arboleda.kinds.arm import Arm, Joint
from arboleda.kinds.declared import Device, DeviceVerb
from arboleda.recipes.storage_cell import StorageCell


def check_rate(rate: float) -> float:
    """The rate itself; StartError where it makes no sense."""
    if not 0.1 <= rate <= 100:
        raise StartError(f"{rate:g} is not a rate; allowed: 0.1 to 100")
    return rate


def at_rate(model: PlantModel, rate: float) -> PlantModel:
    """The same plant, its robots `rate` times as fast, accelerating so that every ramp keeps its shape."""
    check_rate(rate)
    return replace(model, cells=tuple(_cell_at_rate(cell, rate) for cell in model.cells))


def _cell_at_rate(cell: Cell, rate: float) -> Cell:
    if not isinstance(cell, StorageCell):
        return replace(cell, members=tuple((role, _at_rate(robot, rate)) for role, robot in cell.members))
    arm: Arm = replace(cell.arm, joints=tuple(_joint_at_rate(joint, rate) for joint in cell.arm.joints))
    return replace(cell, arm=arm, mobile=replace(cell.mobile, speed=cell.mobile.speed * rate))


def _at_rate(robot: Robot, rate: float) -> Robot:
    if not isinstance(robot, Device):
        return robot
    verbs = {name: _verb_at_rate(verb, rate) for name, verb in robot.kind.verbs.items()}
    return replace(robot, kind=replace(robot.kind, verbs=verbs))


def _verb_at_rate(verb: DeviceVerb, rate: float) -> DeviceVerb:
    """A slower device is waited for longer, a faster one as long as before."""
    return replace(verb, takes_s=verb.takes_s / rate, at_most_s=verb.at_most_s / min(rate, 1.0))


def _joint_at_rate(joint: Joint, rate: float) -> Joint:
    return replace(joint, speed=joint.speed * rate, acceleration=joint.acceleration * rate**2)
