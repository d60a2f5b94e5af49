"""Plants that seeds draw, checked in the same way as a user's file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import yaml

from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import loader
from arboleda.plant_file.robot_models import arm_models, mobile_models
from arboleda_proofs.simulator import plants
from arboleda_proofs.simulator.chance import Dice
from arboleda_proofs.simulator.plants import devices
from arboleda_proofs.simulator.plants.devices import DrawnDevices

from .plants import Plant

ATTEMPTS = 200  # files drawn for one seed; `check` accepts about every second one
RECENT = 16  # drawn plants that are kept
OF_DEVICES = 0.5  # how often a plant has cells of devices
NOTHING: Mapping[str, str] = {}


@dataclass(frozen=True, kw_only=True)
class RandomPlants:
    """A plant of its own for each seed, the first one that `arboleda check` takes; half are of devices."""

    def of(self, seed: int) -> Plant:
        return (of_devices if Dice(seed, "sort of plant").chance(OF_DEVICES) else of_storage)(seed)


def loaded(drawn: dict[str, Any] | DrawnDevices, beside: Mapping[str, str] = NOTHING) -> Plant:
    """The plant of such a content and the files beside it; ConfigError as for a user's file.

    Drawn recipes come to an end: they are tried in this process, so that no clock has a say in what is drawn.
    """
    if isinstance(drawn, DrawnDevices):
        return replace(_in_a_folder(drawn.file, drawn.beside, apart=False), drawn=drawn)
    if beside:
        return _in_a_folder(drawn, beside)
    name, content = _name(drawn), as_yaml(drawn).encode()
    files = PlantFiles(plant=name, contents={name: content})
    return Plant(declared=loader.parse(name, content), file=drawn, files=files)


def _name(file: dict[str, Any]) -> str:
    return f"{file.get('name', 'plant')}.yaml"


def _in_a_folder(file: dict[str, Any], beside: Mapping[str, str], *, apart: bool = True) -> Plant:
    """The plant, read from a folder of its own as that of a person; `apart` as of `loader.load`."""
    name = _name(file)
    with TemporaryDirectory(prefix="arboleda-drawn-") as made:
        path = Path(made) / name
        for each, text in {name: as_yaml(file), **beside}.items():
            (path.parent / each).write_text(text, encoding="utf-8")
        declared, files = loader.load_with_files(path, apart=apart)
    return Plant(declared=declared, file=file, beside=beside, files=files)


def keep(plant: Plant, folder: Path) -> Path:
    """Write the files of a plant into a folder; the path of the plant file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in plant.files.contents.items():
            (folder / name).write_bytes(content)
    except OSError as error:
        raise ArboledaError(f"{folder}: the plant cannot be written there: {error.strerror}") from None
    return folder / plant.files.plant


def smaller(plant: Plant) -> Iterator[dict[str, Any] | DrawnDevices]:
    """Smaller plants to try instead of this one; nothing for a plant of the user."""
    if plant.drawn is not None:
        yield from devices.smaller(plant.drawn)
    elif plant.file is not None and not plant.beside:
        yield from plants.smaller(plant.file)


def as_yaml(file: dict[str, Any]) -> str:
    """The content of a plant file, roughly as a person would write it."""
    return yaml.safe_dump(file, sort_keys=False, default_flow_style=None, width=110, allow_unicode=True)


def of_devices(seed: int) -> Plant:
    """The first plant with cells of devices that this seed draws and `arboleda check` takes."""
    return _first(devices.draw, seed)


def of_storage(seed: int) -> Plant:
    """The same, with cells of an arm, a mobile robot and a rack."""
    return _first(_storage, seed)


@lru_cache(maxsize=RECENT)
def _first(draw: Callable[[int, int], dict[str, Any] | DrawnDevices], seed: int) -> Plant:
    for attempt in range(ATTEMPTS):
        try:
            return loaded(draw(seed, attempt))
        except ConfigError as refusal:
            last = refusal
    raise last


def _storage(seed: int, attempt: int) -> dict[str, Any]:
    arms = {name: model.joints for name, model in arm_models().items()}
    mobiles = {name: model.speed for name, model in mobile_models().items()}
    return plants.draw(seed, attempt, arms=arms, mobiles=mobiles)
