"""Versions of a plant: what a cell takes of another version between two tasks, and what it cannot take."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from .plant_model import Cell, PlantModel, Workspace
from .sentence import Phrase, Sentence

Versions = Mapping[str, PlantModel]
"""The versions of a plant by their digests."""
OTHER_CELLS = Phrase("revision.cells", "its cells are others, or in another order")
OTHER_DEVICES = Phrase("revision.devices", "the devices of {cell} are others")
OTHER_ZONES = Phrase("revision.zones", "the zones of {cell} are others")
OTHER_PLACES = Phrase("revision.places", "the places, needs or interlocks of {cell} are others")
OTHER_HOME = Phrase("revision.home", "{robot}, which cells share, has another home")
OTHER_EXTENSIONS = Phrase("revision.extensions", "the settings of its packages are others")
OTHER_PLANT = Phrase("revision.plant", "its name, its store, its links or its longest silence are others")
BETWEEN_TASKS = (
    "recipes",
    "arrays",
    "grids",
    "queue_limit",
    "goes_on",
    "goes_on_after_absence",
    "retry",
    "piece_check",
    "drive_to_start",
    "zone_wait_s",
    "handover",
    "teach",
)


def revised(cell: Cell, other: Cell) -> Cell:
    """The cell with its own devices, and all of `other` that it can take between two tasks."""
    spaces = {space.robot.name: space for space in other.spaces}
    taken = {name: getattr(other, name) for name in BETWEEN_TASKS}
    own = tuple(_revised(space, spaces[space.robot.name]) for space in cell.spaces)
    return replace(cell, spaces=own, **taken)


def obstacle(plant: PlantModel, other: PlantModel) -> Sentence | None:
    """The first thing in another version that a running plant cannot take; None where it can take all."""
    if _of_plant(plant) != _of_plant(other):
        return OTHER_PLANT()
    if (plant.extensions, plant.extensions_off) != (other.extensions, other.extensions_off):
        return OTHER_EXTENSIONS()
    if [cell.name for cell in plant.cells] != [cell.name for cell in other.cells]:
        return OTHER_CELLS()
    pairs = zip(plant.cells, other.cells, strict=True)
    return next((obstacle for pair in pairs for obstacle in _obstacles(*pair)), None)


def _revised(space: Workspace, other: Workspace) -> Workspace:
    return replace(other, robot=space.robot, tool=space.tool)


def _of_plant(plant: PlantModel) -> tuple[object, ...]:
    links = (plant.mqtt_version, plant.foreign_commands, plant.groot2_port, plant.opcua_view)
    return (plant.name, plant.store, plant.zones, *links, plant.timing.stale_after_s)


def _obstacles(cell: Cell, other: Cell) -> Iterator[Sentence]:
    if _devices(cell) != _devices(other):
        yield OTHER_DEVICES(cell=cell.name)
        return
    if _zoned(cell) != _zoned(other):
        yield OTHER_ZONES(cell=cell.name)
    if _fixed(cell) != _fixed(other):
        yield OTHER_PLACES(cell=cell.name)
    for robot in cell.shared_movers:
        if cell.reach[robot].home.q != other.reach[robot].home.q:
            yield OTHER_HOME(robot=robot)


def _devices(cell: Cell) -> tuple[object, ...]:
    """All of a cell's devices that no version may change: roles, names, kinds, links and tools."""
    devices = [(role, each.name, each.mqtt, each.kind_name, each.link) for role, each in cell.members]
    spaces = [(each.robot.name, each.tool and each.tool.name, each.returns) for each in cell.spaces]
    between = cell.handover and (cell.handover.taker, cell.handover.giver)
    return devices, spaces, between, cell.shared


def _zoned(cell: Cell) -> list[tuple[object, ...]]:
    return [
        (space.robot.name, {pose.name: pose.zones for pose in space.poses if pose.zones}, space.crossings)
        for space in cell.spaces
    ]


def _fixed(cell: Cell) -> tuple[object, ...]:
    return cell.interlocks, cell.needs, cell.counted
