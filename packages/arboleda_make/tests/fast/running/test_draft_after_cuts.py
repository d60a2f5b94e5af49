"""A draft goes on after each kill and power cut: what was answered is there, and it can be kept."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.cuts import End, each_cut

from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file import versions
from arboleda.plant_file.draft import DraftCheck
from arboleda.plant_file.versions import Version, Versions, version_of
from arboleda.runtime import at_work
from arboleda_make.drafts.desk import DraftDesk
from arboleda_make.drafts.file import DAMAGED, FILE, FOLDER, MEANT, OPENED
from arboleda_make.drafts.plant_folder import PlantFolder

AT = "2026-11-25T20:00:00+00:00"
ANA = "ana-12345"
TEXT = b"name: a\ntiming: {dwell_s: 1}\n"
DWELL = ("timing", "dwell_s")
Act = Callable[[DraftDesk], object]


class Plant:
    """A plant with its files and its state in a folder, and the starts of it."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file, self.state = folder, folder / "plant.yaml", folder / "state"

    def start(self) -> DraftDesk:
        """A start of the plant: it goes on with a version that was cut off, and keeps what it is made of."""
        Versions(self.file).go_on()
        at_work.keep(self.state, self.files(), AT)
        desk = DraftDesk(PlantFolder(self.file, self.state), self.state, Checker(), work_by=self._work_by)
        desk.take(ANA, "ana")
        return desk

    def files(self) -> PlantFiles:
        there = [self.file, *self.folder.glob("*.xml")]
        return PlantFiles(plant=self.file.name, contents={each.name: each.read_bytes() for each in there})

    def _work_by(self, version: Version, found: DraftCheck, by: str) -> dict[str, Any]:
        at_work.keep(self.state, version.files, AT)
        return {"version": version.number}


class Checker:
    """Finds every draft good."""

    def check(self, files: PlantFiles, plant_file: Path) -> DraftCheck:
        return DraftCheck(read=files)

    def stop(self) -> None: ...


@pytest.fixture
def plant(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Plant:
    monkeypatch.setattr(os, "fsync", lambda file: None)  # what is lost without it, `each_cut` says
    found = Plant(tmp_path / "plant")
    found.state.mkdir(parents=True)
    found.file.write_bytes(TEXT)
    return found


def dwell(desk: DraftDesk) -> int:
    return int(desk.state()["values"]["timing"]["dwell_s"])


def goes_on(plant: Plant, desk: DraftDesk, cut: End | None = None) -> None:
    """The draft of a start can be changed, and becomes a version that the next start has."""
    desk.set(ANA, DWELL, 7)
    assert desk.keep(ANA, "")["version"], cut
    assert b"dwell_s: 7" in plant.file.read_bytes() and desk.state()["changes"] == [], cut
    assert dwell(plant.start()) == 7, cut


def test_the_first_edit_of_a_draft_is_there_once_it_is_answered(plant: Plant) -> None:
    for cut in each_cut(plant.folder, lambda: plant.start().set(ANA, DWELL, 2)):
        desk = plant.start()
        assert dwell(desk) in ([2] if cut.is_whole else [1, 2]) and not desk.state()["set_aside"], cut
        goes_on(plant, desk, cut)


ACTS: dict[str, tuple[Act, int]] = {
    "an edit": (lambda desk: desk.set(ANA, DWELL, 3), 3),
    "discard": (lambda desk: desk.discard(ANA), 1),
    "keep": (lambda desk: desk.keep(ANA, ""), 2),
    "put to work": (lambda desk: desk.apply(ANA, ""), 2),
}


@pytest.mark.long
@pytest.mark.parametrize(("act", "after"), ACTS.values(), ids=ACTS)
def test_a_draft_goes_on_after_each_cut(plant: Plant, act: Act, after: int) -> None:
    plant.start().set(ANA, DWELL, 2)
    for cut in each_cut(plant.folder, lambda: act(plant.start())):
        desk = plant.start()
        assert dwell(desk) in ([after] if cut.is_whole else [2, after]), cut
        assert not desk.state()["set_aside"], cut
        goes_on(plant, desk, cut)


@pytest.mark.long
def test_a_version_of_several_files_is_in_its_place_whole_or_still_a_draft(plant: Plant) -> None:
    desk = plant.start()
    desk.set(ANA, DWELL, 2)
    desk.set_trees(ANA, "tend.xml", "<root/>")
    for cut in each_cut(plant.folder, lambda: plant.start().apply(ANA, "")):
        desk = plant.start()
        state = desk.state()
        assert state["trees"] == ["tend.xml"] and state["values"]["timing"]["dwell_s"] == 2, cut
        is_there = [b"dwell_s: 2" in plant.file.read_bytes(), (plant.folder / "tend.xml").exists()]
        assert is_there == ([False, False] if state["changes"] else [True, True]), cut
        goes_on(plant, desk, cut)


def test_files_that_are_copied_to_be_ones_own_are_whole_or_not_there(plant: Plant) -> None:
    def own() -> None:
        PlantFolder(None, plant.state).own(version_of(plant.files(), at=AT))

    for cut in each_cut(plant.folder, own):
        file = plant.state / "files" / "plant.yaml"
        assert (not file.parent.exists() and not cut.is_whole) or file.read_bytes() == TEXT, cut


def test_a_draft_that_is_damaged_is_set_aside_and_said(plant: Plant) -> None:
    plant.start().set(ANA, DWELL, 2)
    (plant.state / FILE).write_text('{"opened": {"plant": "pla')
    desk = plant.start()
    (said,) = desk.state()["set_aside"]
    assert "was no whole draft" in said and f"{FILE}{DAMAGED}" in said
    assert (plant.state / f"{FILE}{DAMAGED}").exists() and dwell(desk) == 1
    goes_on(plant, desk)


def in_folders(plant: Plant) -> Path:
    """The draft of a plant as it was kept before it had a file."""
    base = plant.files()
    meant = replace(base, contents={"plant.yaml": TEXT.replace(b": 1}", b": 2}")})
    for part, files in ((OPENED, base), (MEANT, meant)):
        versions.write(plant.state / FOLDER / part, version_of(files, at=AT))
    return plant.state / FOLDER


def test_a_draft_in_folders_goes_on_in_its_file(plant: Plant) -> None:
    in_folders(plant)
    for cut in each_cut(plant.folder, plant.start):
        desk = plant.start()
        assert dwell(desk) == 2 and not (plant.state / FOLDER).exists(), cut
        goes_on(plant, desk, cut)


def test_half_a_draft_in_folders_is_set_aside_and_said(plant: Plant) -> None:
    (in_folders(plant) / MEANT / versions.FACTS).unlink()
    desk = plant.start()
    assert FOLDER + DAMAGED in desk.state()["set_aside"][0] and dwell(desk) == 1
    assert desk.discard(ANA)["set_aside"] == []
