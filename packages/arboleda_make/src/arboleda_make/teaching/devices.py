"""Devices of a cell as whoever teaches it sees them: where each stands, and what it can be told."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from arboleda.drivers import Device, DeviceVerb, FactType, Position, Robot
from arboleda.engine import CellRun, Plant
from arboleda.engine.inspection import beliefs_of, obstacles_of, teaching_of
from arboleda.model.by_class import nearest
from arboleda.model.messages import OperatorRequest, Verb
from arboleda.views import view
from arboleda_make.teaching.api import Spot, TeachRefused

Row = dict[str, Any]
DIGITS = 3  # of a degree or a millimetre, finer than any motor step
NO_CELL = "there is no cell {cell}; there are {known}"
WRONG_SPOT = "{robot} goes to {wanted}"


def cell_of(plant: Plant, name: str) -> CellRun:
    """The cell of that name; TeachRefused names those that there are."""
    if name not in plant.cells:
        raise TeachRefused(NO_CELL.format(cell=name, known=", ".join(plant.cells)))
    return plant.cells[name]


def state(plant: Plant, name: str) -> Row:
    """The person who teaches a cell, why nobody may begin now, and its devices."""
    cell = cell_of(plant, name)
    request = OperatorRequest(at=plant.now, verb=Verb.TEACH, scope=name, arguments=(("teacher", "x"),))
    refusal = plant.refusal(request) if teaching_of(cell) is None else None
    devices = [_device(plant, role, robot) for role, robot in cell.cell.members if robot in cell.cell.reached]
    return {
        "cell": name,
        "teaching": view.teaching(plant, cell),
        "refusal": refusal,
        "devices": [each for each in devices if each is not None],
    }


def standing(plant: Plant, robot: str) -> Row:
    """Position of a robot, as people write it, whoever moved it there; and why it takes no command now."""
    belief, obstacle = beliefs_of(plant)[robot], obstacles_of(plant).of(robot)
    at = belief.known_position
    return {
        "name": robot,
        "at": None if at is None else spot(belief.robot, at),
        "homed": belief.homed,
        "moves": belief.moves,
        "obstacle": None if obstacle is None or belief.moves else obstacle.sentence,
        "facts": {name: belief.fact(name) for name in belief.robot.fact_names},
    }


def spot(robot: Robot, at: Position) -> Spot:
    """A position in degrees and millimetres, or as a node."""
    if isinstance(at, int):
        return at
    return [round(_shown(joint.unit, value), DIGITS) for joint, value in zip(robot.joints, at, strict=True)]


def position(robot: Robot, at: Spot) -> Position:
    """A position of people in SI units; TeachRefused where the robot has no such."""
    if robot.floor_grid is not None and isinstance(at, int):
        return at
    if robot.joints and isinstance(at, Sequence) and len(at) == len(robot.joints):
        rows = zip(robot.joints, at, strict=True)
        return tuple(math.radians(value) if joint.unit == "rad" else value / 1000 for joint, value in rows)
    wanted = f"{len(robot.joints)} values of its joints" if robot.joints else "a node"
    raise TeachRefused(WRONG_SPOT.format(robot=robot.name, wanted=wanted))


def _shown(unit: str, value: float) -> float:
    return math.degrees(value) if unit == "rad" else value * 1000


def _device(plant: Plant, role: str, robot: Robot) -> Row | None:
    if robot.is_person:
        return None
    return {
        **standing(plant, robot.name),
        "role": role,
        "kind": robot.kind_name,
        "joints": [_joint(each) for each in robot.joints],
        "nodes": robot.floor_grid.size if robot.floor_grid is not None else 0,
        "columns": robot.floor_grid.columns if robot.floor_grid is not None else 0,
        "homes": robot.homes,
        "holds": robot.held_fact is not None and robot.goes,
        "verbs": _verbs(robot),
    }


def _verbs(robot: Robot) -> list[Row]:
    """The verbs of a device of a declared kind, with the form of each."""
    rows = nearest(VERBS, type(robot))
    return [] if rows is None else rows(robot)


def _joint(joint: Any) -> Row:
    return {
        "name": joint.name.removesuffix("_joint"),
        "unit": "deg" if joint.unit == "rad" else "mm",
        "lower": round(_shown(joint.unit, joint.lower), DIGITS),
        "upper": round(_shown(joint.unit, joint.upper), DIGITS),
    }


def _verb(verb: DeviceVerb) -> Row:
    return {"name": verb.name, "parameters": [_parameter(name, of) for name, of in verb.parameters]}


def _parameter(name: str, of: FactType) -> Row:
    return {
        "name": name,
        "type": of.type.__name__,
        "choices": list((False, True) if of.type is bool else of.words),
        "lower": of.lower if of.is_limited else None,
        "upper": of.upper if of.is_limited else None,
        "first": of.first,
    }


def _declared(device: Device) -> list[Row]:
    return [_verb(each) for each in device.kind.verbs.values()]


VERBS: dict[type[Robot], Callable[[Any], list[Row]]] = {Device: _declared}
