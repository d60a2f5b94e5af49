"""Targets of faults, by name: boards, lines and processes as the world names them, robots and cells."""

from __future__ import annotations

from typing import cast

from arboleda.drivers import Evidence, Query, Robot
from arboleda.model.plant_model import Link, PlantModel
from arboleda.rig.world import BRIDGE, PLANT
from arboleda.sim.arm import ArmBody
from arboleda.sim.machine import MachineBody

from .board_site import BoardSite


def boards(model: PlantModel) -> tuple[str, ...]:
    """Every board, by MQTT name."""
    return tuple(robot.mqtt for robot in _reached(model))


def arms(model: PlantModel) -> tuple[str, ...]:
    """The boards of robots of joints."""
    return tuple(robot.mqtt for robot in _reached(model) if robot.joints)


def hands(model: PlantModel) -> tuple[str, ...]:
    """The boards of arms with effectors."""
    return tuple(robot.mqtt for robot in _reached(model) if _is_hand(robot))


def machines(model: PlantModel) -> tuple[str, ...]:
    """The boards of devices of declared kinds."""
    return tuple(robot.mqtt for robot in _reached(model) if robot.verb_names)


def askable(model: PlantModel) -> tuple[str, ...]:
    """The boards of devices that can be queried."""
    return tuple(robot.mqtt for robot in _reached(model) if queries(robot))


def queries(robot: Robot) -> tuple[str, ...]:
    """The verbs by which a device can be queried."""
    asking = (words for words, make in robot.calls.items() if isinstance(make(id=""), Query))
    return tuple(dict.fromkeys(words.partition(" ")[0] for words in asking))


def tellers(model: PlantModel) -> tuple[str, ...]:
    """The boards of devices that report facts."""
    devices = (robot for robot in _reached(model) if robot.verb_names)
    return tuple(robot.mqtt for robot in devices if robot.fact_names)


def holders(model: PlantModel) -> tuple[str, ...]:
    """The boards of devices that can hold a part."""
    devices = (robot for robot in _reached(model) if robot.verb_names)
    return tuple(robot.mqtt for robot in devices if robot.held_fact is not None)


def goers(model: PlantModel) -> tuple[str, ...]:
    """The boards of robots that drive from place to place."""
    return tuple(robot.mqtt for robot in _reached(model) if robot.goes)


def feelers(model: PlantModel) -> tuple[str, ...]:
    """The boards of arms that report what their piece sensor sees."""
    candidates = (robot for robot in _reached(model) if robot.evidence is Evidence.IDS)
    return tuple(robot.mqtt for robot in candidates if _is_hand(robot))


def clients(model: PlantModel) -> tuple[str, ...]:
    """Every process that has a connection to the broker."""
    return (*boards(model), BRIDGE)


def robots(model: PlantModel) -> tuple[str, ...]:
    """Robots by their own names."""
    return tuple(robot.name for robot in _reached(model))


def cells(model: PlantModel) -> tuple[str, ...]:
    return tuple(cell.name for cell in model.cells)


def plant(model: PlantModel) -> tuple[str, ...]:
    return (PLANT,)


def bridge(model: PlantModel) -> tuple[str, ...]:
    return (BRIDGE,)


def store(model: PlantModel) -> tuple[str, ...]:
    return ("store",)


def broker(model: PlantModel) -> tuple[str, ...]:
    return ("broker",)


def robot_of(model: PlantModel, board: str) -> Robot:
    """The robot that a board drives."""
    return next(robot for robot in model.robots.values() if robot.mqtt == board)


def arm_body(world: BoardSite, board: str) -> ArmBody:
    """The axes and the effector of an arm's board."""
    return cast(ArmBody, world.boards[board].body)


def machine_body(world: BoardSite, board: str) -> MachineBody:
    """The virtual body of the board of a declared device."""
    return cast(MachineBody, world.boards[board].body)


def _is_hand(robot: Robot) -> bool:
    return bool(robot.joints) and robot.has_effector


def _reached(model: PlantModel) -> list[Robot]:
    return [robot for robot in model.robots.values() if robot.link is Link.MQTT]
