"""Versions of a plant that runs: what is no version is refused with those that there are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.plant_folder import PlantFolder
from arboleda_make.versions.desk import VersionDesk

NO_PLANT: Any = None


def never(*_: Any) -> Any:
    raise AssertionError("nothing is checked, and no plant is told")


def test_a_number_that_is_no_version_is_refused_with_those_that_are(tmp_path: Path) -> None:
    plant = tmp_path / "plant.yaml"
    plant.write_text("name: a\n")
    folder = PlantFolder(plant, tmp_path / "state")
    desk = VersionDesk(folder, tmp_path / "state", NO_PLANT, as_it_runs=never, check=never)
    with pytest.raises(DraftRefused, match=r"there is no version 77 .*; kept: none"):
        desk.put(77, "ana")


def test_a_plant_that_nobody_would_start_again_does_not_restart(tmp_path: Path) -> None:
    folder = PlantFolder(tmp_path / "plant.yaml", tmp_path / "state")
    desk = VersionDesk(folder, tmp_path / "state", NO_PLANT, as_it_runs=never, check=never)
    with pytest.raises(DraftRefused, match="is restarted by who started it"):
        desk.restart("ana", wanted=True)
