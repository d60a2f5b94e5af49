"""Plants that seeds are simulated on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

from arboleda.model.plant_files import NO_FILES, PlantFiles
from arboleda.model.plant_model import Link, PlantModel
from arboleda_proofs.simulator.findings import Finding
from arboleda_proofs.simulator.invariants import Invariant

ELSEWHERE = (Link.ROS, Link.NONE, Link.DRIVER)  # robots without a board on MQTT, which get a virtual one


@dataclass(frozen=True, kw_only=True)
class Plant:
    """One plant: `declared` as its file says it, `files` are the ones that it was read from, for its record.

    A plant that no file of a person has says more of itself: what is empty here.
    """

    declared: PlantModel
    files: PlantFiles = NO_FILES

    @property
    def name(self) -> str:
        return self.declared.name

    @property
    def plain(self) -> dict[str, Any]:
        """Its content as plain data for `--json`."""
        return {}

    @property
    def texts(self) -> Mapping[str, str]:
        """Its files by name, for a person to read; the plant file is the first."""
        return {}

    @property
    def rules(self) -> tuple[Invariant, ...]:
        """The rules of this plant, beside those of every plant."""
        return ()

    def smaller(self) -> Iterable[Callable[[], Plant]]:
        """Plants with less in them, to find the least that breaks; ConfigError where there can be none."""
        return ()

    def intends(self, finding: Finding) -> bool:
        """True if its recipes have this go wrong on purpose."""
        return False

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
