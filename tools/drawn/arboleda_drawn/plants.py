"""Plants that seeds draw, checked in the same way as a user's file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import yaml

from arboleda.extension import ArboledaError
from arboleda.model.errors import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import loader
from arboleda.plant_file.robot_models import arm_models, mobile_models
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.findings import Finding, FindingKind
from arboleda_proofs.simulator.invariants import Invariant

from . import devices, storage
from .as_drawn import as_drawn
from .devices import DrawnDevices, Form

ATTEMPTS = 200  # files drawn for one seed; `check` accepts about every second one
RECENT = 16  # drawn plants that are kept
OF_DEVICES = 0.5  # how often a plant has cells of devices
NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True, kw_only=True)
class DrawnPlant(Plant):
    """A plant that a seed draws: `file` is the content of its file, `beside` are texts of files by name.

    `drawn` is what both were written from, of a plant with cells of devices.
    """

    file: dict[str, Any]
    beside: Mapping[str, str] = field(default_factory=dict)
    drawn: DrawnDevices | None = None

    @property
    def plain(self) -> dict[str, Any]:
        return {"plant_file": self.file, **({"plant_files": dict(self.beside)} if self.beside else {})}

    @property
    def texts(self) -> Mapping[str, str]:
        return {_name(self.file): as_yaml(self.file), **self.beside}

    @property
    def rules(self) -> tuple[Invariant, ...]:
        """Its recipes do what was drawn."""
        if self.drawn is None:
            return ()
        return (as_drawn(self.drawn.recipes, pauses=self.drawn.form is Form.PYTHON),)

    def smaller(self) -> Iterator[Callable[[], Plant]]:
        if self.drawn is not None:
            return (partial(loaded, less) for less in devices.smaller(self.drawn))
        return (partial(loaded, less) for less in ([] if self.beside else storage.smaller(self.file)))

    def intends(self, finding: Finding) -> bool:
        """True for a command that a drawn recipe has refused, and for a rescue that it has fail."""
        if self.drawn is None:
            return False
        if finding.kind is not FindingKind.COMMAND:
            return finding.sentence.endswith(self.drawn.failing_rescues)
        called = [
            (cell.roles[role].name, verb) for cell in self.model.cells for role, verb in self.drawn.refused
        ]
        names = [f"{device}: doing {verb}" for device, verb in called]
        return any(finding.step == name or finding.step.startswith(f"{name} ") for name in names)


@dataclass(frozen=True, kw_only=True)
class DrawnPlants:
    """A plant of its own for each seed, the first one that `arboleda check` takes; half are of devices."""

    def of(self, seed: int) -> DrawnPlant:
        return (of_devices if Dice(seed, "sort of plant").chance(OF_DEVICES) else of_storage)(seed)


def loaded(drawn: dict[str, Any] | DrawnDevices, beside: Mapping[str, str] = NOTHING) -> DrawnPlant:
    """The plant of such a content and the files beside it; ConfigError as for a user's file.

    Drawn recipes come to an end: they are tried in this process, so that no clock has a say in what is drawn.
    """
    if isinstance(drawn, DrawnDevices):
        return replace(_in_a_folder(drawn.file, drawn.beside, apart=False), drawn=drawn)
    if beside:
        return _in_a_folder(drawn, beside)
    name, content = _name(drawn), as_yaml(drawn).encode()
    files = PlantFiles(plant=name, contents={name: content})
    return DrawnPlant(declared=loader.parse(name, content), file=drawn, files=files)


def _name(file: dict[str, Any]) -> str:
    return f"{file.get('name', 'plant')}.yaml"


def _in_a_folder(file: dict[str, Any], beside: Mapping[str, str], *, apart: bool = True) -> DrawnPlant:
    """The plant, read from a folder of its own as that of a person; `apart` as of `loader.load`."""
    name = _name(file)
    with TemporaryDirectory(prefix="arboleda-drawn-") as made:
        path = Path(made) / name
        for each, text in {name: as_yaml(file), **beside}.items():
            (path.parent / each).write_text(text, encoding="utf-8")
        declared, files = loader.load_with_files(path, apart=apart)
    return DrawnPlant(declared=declared, file=file, beside=beside, files=files)


def keep(plant: Plant, folder: Path) -> Path:
    """Write the files of a plant into a folder; the path of the plant file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in plant.files.contents.items():
            (folder / name).write_bytes(content)
    except OSError as error:
        raise ArboledaError(f"{folder}: the plant cannot be written there: {error.strerror}") from None
    return folder / plant.files.plant


def as_yaml(file: dict[str, Any]) -> str:
    """The content of a plant file, roughly as a person would write it."""
    return yaml.safe_dump(file, sort_keys=False, default_flow_style=None, width=110, allow_unicode=True)


def of_devices(seed: int) -> DrawnPlant:
    """The first plant with cells of devices that this seed draws and `arboleda check` takes."""
    return _first(devices.draw, seed)


def of_storage(seed: int) -> DrawnPlant:
    """The same, with cells of an arm, a mobile robot and a rack."""
    return _first(_storage, seed)


@lru_cache(maxsize=RECENT)
def _first(draw: Callable[[int, int], dict[str, Any] | DrawnDevices], seed: int) -> DrawnPlant:
    for attempt in range(ATTEMPTS):
        try:
            return loaded(draw(seed, attempt))
        except ConfigError as refusal:
            last = refusal
    raise last


def _storage(seed: int, attempt: int) -> dict[str, Any]:
    arms = {name: model.joints for name, model in arm_models().items()}
    mobiles = {name: model.speed for name, model in mobile_models().items()}
    return storage.draw(seed, attempt, arms=arms, mobiles=mobiles)
