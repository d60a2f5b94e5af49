"""What a person asks of `arboleda simulate`, checked as a whole before anything runs."""

from __future__ import annotations

import shlex
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from importlib.resources import as_file, files
from itertools import count
from pathlib import Path

from arboleda.core.errors import ConfigError
from arboleda.core.model import Cell, Link, PlantModel
from arboleda.simulator.climate import LEVELS, BadFaults

from .. import config
from .faults_file import Told, read
from .setting import Setting

SEED, SEEDS, CYCLES, LEVEL = 1, 20, 50, "normal"


@dataclass(frozen=True, kw_only=True)
class Request:
    """The options; None stands for one that was not given."""

    plant: Path | None = None
    seed: int | None = None
    seeds: int | None = None
    cycles: int = CYCLES
    faults: str = LEVEL
    until_failure: bool = False

    @property
    def first(self) -> int:
        """The first seed, or the only one."""
        if self.told is not None and self.told.seed is not None:
            return self.told.seed
        return SEED if self.seed is None else self.seed

    @property
    def count(self) -> int | None:
        """How many seeds; None: until something breaks."""
        if self.told is not None and self.told.seed is not None:
            return 1
        return self.seeds or (None if self.until_failure else SEEDS)

    @property
    def turn(self) -> Iterable[int]:
        """The seeds, one after the other."""
        return count(self.first) if self.count is None else range(self.first, self.first + self.count)

    @cached_property
    def told(self) -> Told | None:
        """What `faults` names where it is a file."""
        if self.faults in LEVELS:
            return None
        if not Path(self.faults).exists():
            known = ", ".join(LEVELS)
            raise ConfigError((f"--faults: '{self.faults}' is neither a file nor a level ({known})",))
        return read(Path(self.faults), self.seed)

    @cached_property
    def plants(self) -> tuple[PlantModel, ...]:
        """As their files describe them: seed n runs on number n modulo their count."""
        plants = (config.load(self.plant),) if self.plant else (shared(), config.load())
        wanted = self.told.plant if self.told else None
        if wanted is None:
            return plants
        if found := tuple(plant for plant in plants if plant.name == wanted):
            return found
        raise ConfigError((f"{self.faults}: is of the plant {wanted}; name its file with --plant",))

    @cached_property
    def setting(self) -> Setting:
        """What is to be simulated; ConfigError where the plant or the faults cannot be used."""
        setting = Setting(
            plants=tuple(on_boards(plant) for plant in self.plants),
            cycles=self.cycles,
            level=self.faults,
            told=self.told.climate if self.told else None,
            seconds=self.told.seconds if self.told else None,
        )
        try:
            for seed in range(self.first, self.first + len(setting.plants)):
                setting.climate(seed)
        except BadFaults as error:
            raise ConfigError((f"{self.faults}: {error} (plant {setting.plant(seed).name})",)) from None
        return setting

    @property
    def notes(self) -> list[str]:
        """What a person should know about what is simulated."""
        robots = [robot for plant in self.plants for robot in plant.robots.values()]
        names = {link: ", ".join(robot.name for robot in robots if robot.link is link) for link in Link}
        instead = "simulated as if each had a virtual board on MQTT"
        others = [link for link in (Link.ROS, Link.NONE) if names[link]]
        return [f"declared link: {link.value}, {instead}: {names[link]}" for link in others]

    def replay(self, seed: int) -> str:
        """The command that runs one seed again, step by step."""
        cycles = ["--cycles", str(self.cycles)] if self.cycles != CYCLES else []
        faults = ["--faults", self.faults] if self.faults != LEVEL else []
        return self._trace("--seed", str(seed), *cycles, *faults)

    def replay_shrunk(self, file: Path, seed: int) -> str:
        """The same with the faults that `file` says are enough."""
        return self._trace("--seed", str(seed), "--faults", str(file))

    def _trace(self, *words: str) -> str:
        plant = ["--plant", str(self.plant)] if self.plant else []
        return shlex.join(["arboleda", "simulate", *words, *plant, "--trace"])


def shared() -> PlantModel:
    """The second packaged plant: what the shipped one does not use."""
    with as_file(files("arboleda").joinpath("plants", "shared.yaml")) as path:
        return config.load(path)


def on_boards(model: PlantModel) -> PlantModel:
    """The plant with every robot on MQTT, where the simulator has boards for them."""
    return replace(model, cells=tuple(_on_boards(cell) for cell in model.cells))


def _on_boards(cell: Cell) -> Cell:
    return replace(cell, arm=replace(cell.arm, link=Link.MQTT), mobile=replace(cell.mobile, link=Link.MQTT))
