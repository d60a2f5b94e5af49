"""Plants that seeds are simulated on; `random_plants.py` has those that seeds draw."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol

from arboleda.model.plant_files import NO_FILES, PlantFiles
from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file.unstated import unknowns
from arboleda_proofs.simulator.plants.devices import DrawnDevices

ELSEWHERE = (Link.ROS, Link.NONE, Link.DRIVER)  # robots without a board on MQTT, which get a virtual one


@dataclass(frozen=True, kw_only=True)
class Plant:
    """One plant: `declared` as its file says it, `file` its content where no file of the user has it.

    `beside` are the texts of files beside that by name, `drawn` what both were written from, where that is
    more than they say. `files` are the ones that it was read from, for its record.
    """

    declared: PlantModel
    file: dict[str, Any] | None = None
    beside: Mapping[str, str] = field(default_factory=dict)
    drawn: DrawnDevices | None = None
    files: PlantFiles = NO_FILES

    @property
    def name(self) -> str:
        return self.declared.name

    @property
    def plain(self) -> dict[str, Any]:
        """Its content as plain data for `--json`; empty for a file of the user."""
        beside = {"plant_files": dict(self.beside)} if self.beside else {}
        return {} if self.file is None else {"plant_file": self.file, **beside}

    @cached_property
    def model(self) -> PlantModel:
        """The plant as it is simulated: every robot on MQTT, if the simulator has a board for it."""
        return self.declared.on_boards(*ELSEWHERE)


class Plants(Protocol):
    """The plant of each seed."""

    def of(self, seed: int) -> Plant: ...


@dataclass(frozen=True, kw_only=True)
class PlantRotation:
    """PlantRotation: some plants, seed n on number n modulo their count."""

    plants: tuple[Plant, ...]

    def of(self, seed: int) -> Plant:
        return self.plants[seed % len(self.plants)]


def notes(plants: Iterable[Plant]) -> list[str]:
    """The notes for a person on how these plants are simulated, and on what nobody can judge in them."""
    listed = list(plants)
    robots = [robot for plant in listed for robot in plant.declared.robots.values()]
    names = {link: ", ".join(robot.name for robot in robots if robot.link is link) for link in Link}
    instead = "simulated as if each had a virtual board on MQTT"
    others = [link for link in ELSEWHERE if names[link]]
    linked = [f"declared link: {link.value}, {instead}: {names[link]}" for link in others]
    return [*linked, *unjudged(listed)]


def unjudged(plants: Iterable[Plant]) -> list[str]:
    """The sentences on what nobody can judge in these plants, as their files do not state it."""
    return [sentence for plant in plants for sentence in unknowns(plant.declared)]
