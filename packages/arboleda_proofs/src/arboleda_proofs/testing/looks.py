"""Looks of a test at a cell and at a robot: as the plant believes them to be, and as they are."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial

from arboleda.drivers import Robot, Value
from arboleda.engine.inspection import beliefs_of
from arboleda.rig.world import World
from arboleda.sim.arm import ArmBody
from arboleda.sim.mobile import MobileBody
from arboleda.views import view

MM_PER_M = 1000.0
Joints = tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class CellLook:
    """A cell as the plant's screens show it; `task` is the id of the task that runs."""

    name: str
    state: str
    task: str | None
    step: str | None
    queue: tuple[str, ...]
    held_by: str | None
    not_ready: str | None
    advice: tuple[str, ...]
    waiting_for: str | None


@dataclass(frozen=True, kw_only=True)
class RobotLook:
    """A robot as it is, and as the plant last heard of it; joints in deg, prismatic ones in mm.

    `joints`, `effector` and `holds` (a part) are None for a mobile robot, `node` for an arm; a device of a
    declared kind has `facts`. `online`, `homed` and what is believed are as the plant heard, None where it
    heard nothing.
    """

    name: str
    online: bool
    homed: bool | None
    joints: Joints | None = None
    believed_joints: Joints | None = None
    node: int | None = None
    believed_node: int | None = None
    effector: bool | None = None
    holds: bool | None = None
    facts: Mapping[str, Value] = field(default_factory=dict)
    believed_facts: Mapping[str, Value | None] = field(default_factory=dict)


def cell(world: World, name: str) -> CellLook:
    """The look at the cell with this name."""
    found = next(each for each in view.snapshot(world.plant)["cells"] if each["name"] == name)
    return CellLook(
        name=name,
        state=found["state"],
        task=found["task"]["id"] if found["task"] else None,
        step=_text(found["step"]),
        queue=tuple(found["queue"]),
        held_by=_text(found["held_by"]),
        not_ready=_text(found["not_ready"]),
        advice=tuple(str(each["said"]) for each in found["advice"]),
        waiting_for=_text(found["waiting_for"]),
    )


def robot(world: World, name: str) -> RobotLook:
    """The look at the robot with this name: its board's body beside the plant's belief."""
    model, belief = world.model.robots[name], beliefs_of(world.plant)[name]
    look = partial(RobotLook, name=name, online=belief.online, homed=belief.homed)
    body = world.boards[model.mqtt].body
    if model.joints and isinstance(body, ArmBody):
        true = tuple(
            joint.step * steps for joint, steps in zip(model.joints, body.motors.true_position, strict=True)
        )
        return look(
            joints=_shown(model, true),
            believed_joints=None if belief.q is None else _shown(model, belief.q),
            effector=body.effector,
            holds=body.holding,
        )
    if isinstance(body, MobileBody):
        return look(node=body.true_node, believed_node=belief.node)
    believed = {fact: belief.fact(fact) for fact in body.true_facts}
    return look(facts=dict(body.true_facts), believed_facts=believed)


def _text(value: object) -> str | None:
    return None if value is None else str(value)


def _shown(arm: Robot, q: Joints) -> Joints:
    """Joints in the units of a plant file."""
    rows = zip(arm.joints, q, strict=True)
    return tuple(math.degrees(value) if joint.unit == "rad" else value * MM_PER_M for joint, value in rows)
