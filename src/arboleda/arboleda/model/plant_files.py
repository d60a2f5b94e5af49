"""Files of a plant, by their paths and with what is in them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class PlantFiles:
    """Plant file under its name, and every file that it uses, by their paths."""

    plant: str
    contents: Mapping[str, bytes] = field(default_factory=dict)


NO_FILES = PlantFiles(plant="plant.yaml")  # of a plant that no file describes
