"""Each mistake in a plant file is named with its line, its place and what is allowed."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader

from ...plants import changed, plant_text, rows, written
from . import test_device_cells, test_own_kinds, test_targets

BESIDE = {  # files beside the plant file of that name
    "device_cells": {"bake.py": test_device_cells.RECIPES},
    "own_kinds": {"kinds/saw.py": test_own_kinds.SAW, "recipes.py": test_own_kinds.RECIPES},
    "targets": {"recipes.py": test_targets.RECIPES},
}
WITHOUT_RECIPES = ("shared_devices", "shared_robots", "target_arrays")
PLANTS = ("config_errors", "handovers", *BESIDE, *WITHOUT_RECIPES)
MISTAKES = {
    f"{plant}: {name}": (plant, *row)
    for plant in PLANTS
    for name, row in rows(__file__, plant, "mistakes.yaml").items()
}


@pytest.mark.sampled(2)
@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(
    tmp_path: Path, mistake: tuple[str, str, str, str, str, int]
) -> None:
    plant, old, new, start, words, *count = mistake
    for name, content in BESIDE.get(plant, {}).items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content, "utf-8")
    file = written(tmp_path, changed(plant_text(__file__, plant), (old, new)))
    with pytest.raises(ConfigError) as refusal:
        loader.load(file, recipes=plant not in WITHOUT_RECIPES)
    found = [each.removeprefix(f"{file}:") for each in refusal.value.problems]
    assert len([each for each in found if each.startswith(start) and words in each]) == 1, found
    assert len(found) == (count[0] if count else 1), found
