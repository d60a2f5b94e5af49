"""Which plant a seed is simulated on; `drawn.py` has those that seeds draw."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol

from arboleda.core.model import Cell, Link, PlantModel
from arboleda.recipes.storage_cell import StorageCell


@dataclass(frozen=True, kw_only=True)
class Plant:
    """One plant: `declared` as its file says it, `file` its content where no file of the user has it."""

    declared: PlantModel
    file: dict[str, Any] | None = None

    @property
    def name(self) -> str:
        return self.declared.name

    @cached_property
    def model(self) -> PlantModel:
        """As it is simulated, every robot on MQTT, where the simulator has boards for them.

        ConfigError where it has cells that cannot be simulated.
        """
        cells = tuple(_on_boards(cell) for cell in self.declared.cells)
        return replace(self.declared, cells=cells)


class Plants(Protocol):
    """The plant of each seed."""

    def of(self, seed: int) -> Plant: ...


@dataclass(frozen=True, kw_only=True)
class InTurn:
    """Some plants, seed n on number n modulo their count."""

    plants: tuple[Plant, ...]

    def of(self, seed: int) -> Plant:
        return self.plants[seed % len(self.plants)]


def notes(plants: Iterable[Plant]) -> list[str]:
    """What a person should know about how these plants are simulated."""
    robots = [robot for plant in plants for robot in plant.declared.robots.values()]
    names = {link: ", ".join(robot.name for robot in robots if robot.link is link) for link in Link}
    instead = "simulated as if each had a virtual board on MQTT"
    others = [link for link in (Link.ROS, Link.NONE) if names[link]]
    return [f"declared link: {link.value}, {instead}: {names[link]}" for link in others]


def _on_boards(cell: Cell) -> StorageCell:
    if not isinstance(cell, StorageCell):
        return cell
    return replace(cell, arm=replace(cell.arm, link=Link.MQTT), mobile=replace(cell.mobile, link=Link.MQTT))
