"""Files that were changed while a standby waited."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.recording import Recording
from arboleda.plant_file.versions import MARK, Versions, version_of
from arboleda.testing import shipped
from arboleda_fleet.standby.changed_files import is_changed, read_again

FILES = PlantFiles(plant="plant.yaml", contents={"plant.yaml": b"name: a", "t.xml": b"<root/>"})


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    for name, content in FILES.contents.items():
        (tmp_path / name).write_bytes(content)
    return tmp_path / "plant.yaml"


def test_files_as_they_were_read_are_not_changed(plant: Path) -> None:
    assert not is_changed(plant, Recording(files=FILES))
    assert not is_changed(plant, None) and not is_changed(None, Recording(files=FILES))


@pytest.mark.parametrize("name", FILES.contents)
def test_another_content_is_seen_and_so_is_none(plant: Path, name: str) -> None:
    (plant.parent / name).write_bytes(b"other")
    assert is_changed(plant, Recording(files=FILES))
    (plant.parent / name).unlink()
    assert is_changed(plant, Recording(files=FILES))


def test_a_version_that_was_cut_off_is_brought_back_first(plant: Path) -> None:
    kept = Versions(plant)
    number = kept.keep(version_of(FILES, at="2026")).number
    plant.write_bytes(b"half")
    (plant.parent / ".arboleda" / plant.name / MARK).write_text(str(number), "ascii")
    assert not is_changed(plant, Recording(files=FILES))
    assert plant.read_bytes() == b"name: a" and kept.go_on() is None


def test_files_that_are_no_plant_leave_it_as_it_was() -> None:
    def again() -> tuple[object, None]:
        raise ConfigError(("plant.yaml:1:1: no",))

    told: list[str] = []
    before = (shipped("sis_a"), None)
    assert read_again(again, before, told.append) is before  # type: ignore[arg-type]
    assert "goes on with the former" in told[0] and "plant.yaml:1:1" in told[0]
