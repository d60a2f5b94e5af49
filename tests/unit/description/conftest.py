"""A plant whose file narrows the limits and speeds of the shipped robots, and widens the grids."""

from __future__ import annotations

import re
from importlib.resources import files
from pathlib import Path

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader

CHANGES = {
    "twin: r1": "twin: r1\n      limits: {q1_deg: [-90, 80], q3_mm: [0, 60]}\n      speeds: {q2_deg_s: 30}",
    "twin: r3": "twin: r3\n      limits: {q2_deg: [-100, 100]}\n      speeds: {q1_deg_s: 20}",
    "  mm: 100\n": "  mm: 60\n",
    "      speed_mm_s: 100\n": "",
}
GRID = re.compile(r"(grid: \{origin_m: \[.*?\]).*\}")


@pytest.fixture(scope="session")
def narrowed(tmp_path_factory: pytest.TempPathFactory) -> PlantModel:
    text = files("arboleda").joinpath("plants/plant.yaml").read_text(encoding="utf-8")
    for old, new in CHANGES.items():
        assert old in text
        text = text.replace(old, new)
    text = GRID.sub(r"\1, yaw_deg: 30, pitch_mm: 350}\n      speed_mm_s: 50", text)
    file: Path = tmp_path_factory.mktemp("plant") / "narrowed.yaml"
    file.write_text(text, encoding="utf-8")
    return loader.load(file)
