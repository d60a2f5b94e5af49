"""Plants that seeds draw, checked in the same way as a user's file."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import yaml

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.plant_file.robot_models import arm_models, mobile_models
from arboleda.recorder.preamble import PlantFiles
from arboleda.simulator import plants

from .plants import Plant

ATTEMPTS = 200  # files drawn for one seed; `check` accepts about every second one
RECENT = 16  # drawn plants that are kept


@dataclass(frozen=True, kw_only=True)
class RandomPlants:
    """A plant file of its own for each seed, the first one that `arboleda check` takes."""

    def of(self, seed: int) -> Plant:
        return _drawn(seed)


def loaded(file: dict[str, Any]) -> Plant:
    """The plant of such a content; ConfigError as for a user's file."""
    name, content = f"{file.get('name', 'plant')}.yaml", as_yaml(file).encode()
    files = PlantFiles(plant=name, contents={name: content})
    return Plant(declared=loader.parse(name, content), file=file, files=files)


def as_yaml(file: dict[str, Any]) -> str:
    """The content of a plant file, roughly as a person would write it."""
    return yaml.safe_dump(file, sort_keys=False, default_flow_style=None, width=110)


@lru_cache(maxsize=RECENT)
def _drawn(seed: int) -> Plant:
    arms = {name: model.joints for name, model in arm_models().items()}
    mobiles = {name: model.speed for name, model in mobile_models().items()}
    for attempt in range(ATTEMPTS):
        try:
            return loaded(plants.draw(seed, attempt, arms=arms, mobiles=mobiles))
        except ConfigError as refusal:
            last = refusal
    raise last
