"""Request of a person to `arboleda simulate`, checked as a whole before anything runs."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import as_file, files
from itertools import count
from pathlib import Path

from arboleda.extension import ConfigError, Phrase
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda_proofs.simulator.checks import BadFaults
from arboleda_proofs.simulator.levels import CRASHES, LEVELS

from .faults_file import FaultsFile, line_of, read
from .options import CYCLES, LEVEL, ONE_SEED, OWN_DEATHS, SEED, SEEDS, STANDBY_OR_REVISIONS
from .plant_notes import notes, unjudged
from .plants import Plant, PlantRotation, Plants
from .setting import Setting

COMMAND = ("arboleda", "simulate")


@dataclass(frozen=True, kw_only=True)
class Request:
    """Request: the options; None stands for one that was not given.

    `plant_here` is the plant file of the working directory, for where no plant is named. `source` has plants
    in place of those of files; `command` is what a person types before the options. `one_seed`: one seed is
    shown, step by step.
    """

    plant: Path | None = None
    plant_here: Path | None = None
    source: Plants | None = None
    command: tuple[str, ...] = COMMAND
    seed: int | None = None
    seeds: int | None = None
    one_seed: bool = False
    cycles: int = CYCLES
    faults: str = LEVEL
    until_failure: bool = False
    any_of: bool = False
    standby: bool = False
    revises: bool = False

    @property
    def exclusion(self) -> Phrase | None:
        """The reason why these options exclude each other; None where they do not."""
        if self.one_seed and ((self.seeds or 1) > 1 or self.until_failure):
            return ONE_SEED
        if self.standby and self.revises:
            return STANDBY_OR_REVISIONS
        return OWN_DEATHS if self.standby and self.faults == CRASHES else None

    @property
    def changes_files(self) -> bool:
        """True if the plant's files are changed while it runs: as asked, or as in the file of a seed."""
        return self.revises or (self.faults_file is not None and self.faults_file.revises)

    @property
    def two_hosts(self) -> bool:
        """True if a second host waits to lead: as asked, or as in the file of a broken seed."""
        return self.standby or (self.faults_file is not None and self.faults_file.standby)

    @property
    def first(self) -> int:
        """The first seed, or the only one."""
        if self.faults_file is not None and self.faults_file.seed is not None:
            return self.faults_file.seed
        return SEED if self.seed is None else self.seed

    @property
    def count(self) -> int | None:
        """The number of seeds; None: until something breaks."""
        if self.one_seed or (self.faults_file is not None and self.faults_file.seed is not None):
            return 1
        return self.seeds or (None if self.until_failure else 1 if self.has_people else SEEDS)

    @property
    def has_people(self) -> bool:
        """True if a file says what people do: then seeds differ by little."""
        return (
            self.faults_file is not None
            and isinstance(self.faults_file.climate, dict)
            and "people" in self.faults_file.climate
        )

    @property
    def turn(self) -> Iterable[int]:
        """The seeds, one after the other."""
        return count(self.first) if self.count is None else range(self.first, self.first + self.count)

    @cached_property
    def faults_file(self) -> FaultsFile | None:
        """The contents of the file that `faults` names; None if it is a level."""
        if self.faults in LEVELS:
            return None
        if not os.path.exists(self.faults):  # unlike Path.exists, False for what can be no file's name
            known = ", ".join(LEVELS)
            raise ConfigError((f"--faults: '{self.faults}' is neither a file nor a level ({known})",))
        return read(Path(self.faults), self.seed)

    @cached_property
    def plants(self) -> Plants:
        """The plants that the seeds run on."""
        return self.source or PlantRotation(plants=self.listed)

    @cached_property
    def listed(self) -> tuple[Plant, ...]:
        """The plants of files; none where `source` has others."""
        if self.source is not None:
            return ()
        wanted = self.faults_file.plant if self.faults_file else None
        named = self.plant or self.plant_here
        known = [loader.load_with_files(named)] if named else []
        if named is None or (self.plant is None and wanted not in (None, known[0][0].name)):
            known += [_shared(), loader.load_with_files()]
        plants = tuple(Plant(declared=model, files=read) for model, read in known)
        if wanted is None:
            return plants
        if found := tuple(plant for plant in plants if plant.name == wanted):
            return found
        raise ConfigError((f"{self.faults}: is of the plant {wanted}; name its file with --plant",))

    @cached_property
    def setting(self) -> Setting:
        """The setting of the simulation; ConfigError if the plant or the faults cannot be used."""
        setting = Setting(
            plants=self.plants,
            cycles=self.cycles,
            level=self.faults,
            faults_data=self.faults_file.climate if self.faults_file else None,
            seconds=self.faults_file.seconds if self.faults_file else None,
            any_of=self.any_of,
            standby=self.two_hosts,
            revises=self.changes_files,
        )
        try:
            for seed in self._checked:
                setting.climate(seed)
                setting.script(setting.plant(seed))
        except BadFaults as error:
            where = line_of(Path(self.faults), error.place)
            name = setting.plant(seed).name
            raise ConfigError((f"{self.faults}: {where}{error} (plant {name})",)) from None
        return setting

    @property
    def _checked(self) -> Iterable[int]:
        """The seeds that stand for all: faults of a file must be possible in each plant."""
        those = 1 if self.faults_file is None else len(self.listed) or self.count or 1
        return range(self.first, self.first + those)

    @property
    def notes(self) -> list[str]:
        """The notes for a person on what is simulated."""
        return notes(self.listed)

    @property
    def unjudged(self) -> list[str]:
        """The sentences on what nobody can judge, as the plant files do not state it."""
        return unjudged(self.listed)

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
        plant += ["--any-of"] if self.any_of else []
        plant += ["--standby"] if self.standby else []
        plant += ["--revisions"] if self.revises else []
        return shlex.join([*self.command, *words, *plant, "--trace"])


def _shared() -> tuple[PlantModel, PlantFiles]:
    with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
        return loader.load_with_files(path)
