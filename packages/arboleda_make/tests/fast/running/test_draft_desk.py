"""The draft of a plant: who edits it, what it leaves alone, and how it becomes a version."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.model.errors import StartError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.draft import DraftCheck, Unstated
from arboleda.plant_file.versions import Version, Versions
from arboleda.runtime import at_work
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.drafts.desk import DraftDesk
from arboleda_make.drafts.plant_folder import PlantFolder

AT = "2026-11-25T20:00:00+00:00"
ANA, BEN = "ana-12345", "ben-12345"
TEXT = b"name: a  # mine\ntiming: {dwell_s: 1}\n"
DWELL = ("timing", "dwell_s")
Open = Callable[..., DraftDesk]


def good(files: PlantFiles, plant_file: Path) -> DraftCheck:
    return DraftCheck(read=files, warnings=("careful",))


def bad(files: PlantFiles, plant_file: Path) -> DraftCheck:
    return DraftCheck(problems=(f"{plant_file}:2:1: no",))


class Checker:
    """Checks files as it is told to."""

    def __init__(self, check: Callable[[PlantFiles, Path], DraftCheck]) -> None:
        self.check = check

    def stop(self) -> None: ...


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    (tmp_path / "plant.yaml").write_bytes(TEXT)
    (tmp_path / "state").mkdir()
    files = PlantFiles(plant="plant.yaml", contents={"plant.yaml": TEXT, "r.py": b"1"})
    at_work.keep(tmp_path / "state", files, AT)
    return tmp_path / "plant.yaml"


@pytest.fixture
def open_desk(plant: Path) -> Open:
    """A desk of the plant, as each start of it has one."""

    def opened(check: Any = good, editor: str = ANA) -> DraftDesk:
        desk = DraftDesk(PlantFolder(plant, plant.parent / "state"), plant.parent / "state", Checker(check))
        if editor:
            desk.take(editor, editor[:3])
        return desk

    return opened


def test_nobody_edits_at_first_and_nothing_differs(open_desk: Open) -> None:
    state = open_desk(editor="").state()
    assert (state["editor"], state["changes"], state["waiting"], state["undo"]) == (None, [], [], 0)
    assert state["values"] == {"name": "a", "timing": {"dwell_s": 1}} and state["file"] == "plant.yaml"


def test_steps_change_the_draft_and_no_file(open_desk: Open, plant: Path) -> None:
    desk = open_desk()
    assert desk.set(ANA, DWELL, 2)["changes"] == ["timing.dwell_s: from 1 to 2"]
    assert desk.remove(ANA, ("timing",))["changes"] == ["timing: gone, it was dwell_s 1"]
    assert desk.undo(ANA)["changes"] == ["timing.dwell_s: from 1 to 2"]
    state = desk.redo(ANA)
    assert (state["undo"], state["redo"]) == (2, 0) and "timing" not in state["values"]
    assert plant.read_bytes() == TEXT


def test_the_second_person_is_told_who_edits_and_may_take_over(open_desk: Open) -> None:
    desk = open_desk()
    desk.set(ANA, DWELL, 2)
    for refused in (lambda: desk.set(BEN, DWELL, 3), lambda: desk.undo(BEN), lambda: desk.keep(BEN, "")):
        with pytest.raises(DraftRefused, match="ana edits this draft since"):
            refused()
    assert desk.take(BEN, "ben")["changes"] == ["timing.dwell_s: from 1 to 2"]
    with pytest.raises(DraftRefused, match="ben edits"):
        desk.set(ANA, DWELL, 4)


def test_who_has_not_begun_edits_nothing(open_desk: Open) -> None:
    with pytest.raises(DraftRefused, match="begin to edit"):
        open_desk(editor="").set(ANA, DWELL, 2)


def test_an_edit_that_cannot_be_is_refused_with_its_sentence(open_desk: Open) -> None:
    with pytest.raises(DraftRefused, match="no such place"):
        open_desk().set(ANA, ("name", "x"), 1)


def test_a_draft_outlives_its_process(open_desk: Open) -> None:
    open_desk().set(ANA, DWELL, 2)
    again = open_desk(editor="").state()
    assert again["changes"] == ["timing.dwell_s: from 1 to 2"] and again["editor"] is None


def test_what_is_discarded_is_gone_from_the_next_start_too(open_desk: Open) -> None:
    desk = open_desk()
    desk.set(ANA, DWELL, 2)
    assert desk.discard(ANA)["changes"] == [] and open_desk().state()["changes"] == []


def test_a_kept_draft_is_in_the_files_and_a_version_and_waits_for_the_next_start(
    open_desk: Open, plant: Path
) -> None:
    desk = open_desk()
    desk.set(ANA, DWELL, 2)
    assert desk.keep(ANA, "slower") == {"version": 2, "problems": (), "warnings": ("careful",)}
    assert plant.read_bytes() == TEXT.replace(b"dwell_s: 1", b"dwell_s: 2")
    state = desk.state()
    assert (state["changes"], state["waiting"]) == ([], ["timing.dwell_s: from 1 to 2"])
    started, kept = Versions(plant).all()
    assert started.files.contents["plant.yaml"] == TEXT and [*started.others] == ["r.py"]
    assert (kept.by, kept.note, kept.changes) == ("ana", "slower", ("timing.dwell_s: from 1 to 2",))


def unsaid(files: PlantFiles, plant_file: Path) -> DraftCheck:
    return DraftCheck(
        read=files, unstated=(Unstated(unknown="nobody knows", place=DWELL, values=({"s": 2},)),)
    )


def test_what_the_check_offers_to_state_is_a_value_for_the_draft_that_was_checked(open_desk: Open) -> None:
    desk = open_desk(unsaid)
    found = desk.check()
    (offer,) = found["offers"]
    assert offer["sentence"] == "nobody knows" and offer["place"] == [*DWELL]
    assert offer["choices"] == [{"text": "timing.dwell_s: {s: 2}", "value": {"s": 2}}]
    state = desk.set(ANA, offer["place"], offer["choices"][0]["value"], found["digest"])
    assert state["values"]["timing"] == {"dwell_s": {"s": 2}} and state["digest"] != found["digest"]


def test_an_offer_for_another_draft_than_the_one_that_there_is_changes_nothing(open_desk: Open) -> None:
    desk = open_desk(unsaid)
    found = desk.check()
    changed = desk.set(ANA, DWELL, 3)
    with pytest.raises(
        DraftRefused, match="has changed since its check, and nothing was set; check it again"
    ):
        desk.set(ANA, DWELL, {"s": 2}, found["digest"])
    assert desk.state() == changed
    assert desk.undo(ANA)["digest"] == found["digest"]


def test_an_offer_is_of_the_files_as_they_are_by_hand_too(open_desk: Open, plant: Path) -> None:
    desk = open_desk(unsaid)
    found = desk.check()
    plant.write_bytes(TEXT.replace(b"1", b"4"))
    with pytest.raises(DraftRefused, match="check it again"):
        desk.set(ANA, DWELL, {"s": 2}, found["digest"])


def test_what_the_check_refuses_changes_nothing(open_desk: Open, plant: Path) -> None:
    desk = open_desk(bad)
    desk.set(ANA, DWELL, 2)
    answer = desk.keep(ANA, "")
    assert answer["version"] is None and answer["problems"] == (f"{plant}:2:1: no",)
    assert plant.read_bytes() == TEXT and Versions(plant).all() == []
    assert desk.state()["changes"] == ["timing.dwell_s: from 1 to 2"]


def test_a_file_that_a_person_edited_meanwhile_is_not_written_over(open_desk: Open, plant: Path) -> None:
    desk = open_desk()
    desk.set(ANA, DWELL, 2)
    edited = TEXT + b"# a word of mine\n"
    plant.write_bytes(edited)
    with pytest.raises(DraftRefused, match=r"plant\.yaml: changed by hand"):
        desk.keep(ANA, "")
    assert plant.read_bytes() == edited


def test_what_was_edited_by_hand_before_is_where_a_draft_begins(open_desk: Open, plant: Path) -> None:
    plant.write_bytes(TEXT.replace(b"dwell_s: 1", b"dwell_s: 5"))
    state = open_desk().state()
    assert (state["changes"], state["waiting"]) == ([], ["timing.dwell_s: from 1 to 5"])


def test_a_draft_that_changes_nothing_goes_on_with_what_somebody_wrote_meanwhile(
    open_desk: Open, plant: Path
) -> None:
    desk = open_desk()
    desk.set(ANA, DWELL, 2)
    desk.undo(ANA)
    plant.write_bytes(TEXT + b"# a word of mine\n")
    desk.set(ANA, DWELL, 3)
    assert desk.keep(ANA, "")["version"] == 2
    assert plant.read_bytes() == TEXT.replace(b"dwell_s: 1", b"dwell_s: 3") + b"# a word of mine\n"


def test_a_draft_that_is_changed_while_it_is_checked_is_not_kept(open_desk: Open, plant: Path) -> None:
    def slow(files: PlantFiles, plant_file: Path) -> DraftCheck:
        desk.set(ANA, DWELL, 3)
        return good(files, plant_file)

    desk = open_desk(slow)
    desk.set(ANA, DWELL, 2)
    with pytest.raises(DraftRefused, match="while it was checked"):
        desk.keep(ANA, "")
    assert plant.read_bytes() == TEXT


def test_where_a_file_cannot_be_written_nothing_is_kept_and_the_draft_stays(
    open_desk: Open, plant: Path
) -> None:
    desk = open_desk()
    desk.set_trees(ANA, "tend.xml", "<root/>")
    (plant.parent / "tend.xml").mkdir()  # a folder in the way
    with pytest.raises(StartError, match=r"tend\.xml cannot be written"):
        desk.keep(ANA, "")
    assert plant.read_bytes() == TEXT and [each.number for each in Versions(plant).all()] == [1]
    assert desk.state()["changes"] == ["uses: new, tend.xml", "tend.xml: new"]


def test_an_empty_draft_is_not_kept(open_desk: Open) -> None:
    with pytest.raises(DraftRefused, match="changes nothing"):
        open_desk().keep(ANA, "")


def test_without_a_record_there_is_no_draft(tmp_path: Path) -> None:
    with pytest.raises(DraftRefused, match="record: off"):
        DraftDesk(PlantFolder(tmp_path / "plant.yaml", tmp_path), tmp_path, Checker(good)).state()


def test_trees_are_a_part_of_the_draft(open_desk: Open, plant: Path) -> None:
    desk = open_desk()
    with pytest.raises(DraftRefused, match="no file of trees"):
        desk.trees("tend.xml")
    state = desk.set_trees(ANA, "tend.xml", "<root/>")
    used = ["uses: new, tend.xml", "tend.xml: new"]
    assert (state["trees"], state["changes"]) == (["tend.xml"], used)
    assert desk.trees("tend.xml") == {"file": "tend.xml", "text": "<root/>"}
    assert desk.undo(ANA)["trees"] == []
    desk.redo(ANA)
    assert desk.remove_trees(ANA, "tend.xml")["trees"] == [] and not (plant.parent / "tend.xml").exists()
    for name in ("../tend.xml", "/etc/passwd", "r.py"):  # of which nobody is told whether they are there
        with pytest.raises(DraftRefused, match="no file of trees"):
            desk.set_trees(ANA, name, "<root/>")


def test_a_new_file_of_trees_is_written_over_no_other_file(open_desk: Open, plant: Path) -> None:
    desk = open_desk()
    (plant.parent / "mine.xml").write_text("mine")
    with pytest.raises(DraftRefused, match="is there already, in the plant's folder"):
        desk.set_trees(ANA, "mine.xml", "<root/>")
    desk.add_trees(ANA, "new.xml", "<root/>")
    with pytest.raises(DraftRefused, match=r"'new\.xml' is there already; choose another"):
        desk.add_trees(ANA, "new.xml", "<root/>")


def test_what_only_a_restart_takes_is_said_before_it_is_kept(open_desk: Open) -> None:
    desk = open_desk()
    assert desk.set(ANA, DWELL, 2)["restart"] == ()
    assert "watch their links" in desk.set(ANA, ("timing", "stale_after_s"), 2)["restart"][0]


def test_a_draft_is_put_to_work_as_the_version_that_it_is_kept_as(plant: Path) -> None:
    put: list[tuple[int, str]] = []

    def work_by(version: Version, found: DraftCheck, by: str) -> dict[str, Any]:
        put.append((version.number, by))
        return {"version": version.number}

    state = plant.parent / "state"
    desk = DraftDesk(PlantFolder(plant, state), state, Checker(good), work_by)
    desk.take(ANA, "ana")
    desk.set(ANA, DWELL, 2)
    assert desk.apply(ANA, "why") == {"version": 2} and put == [(2, "ana")]
    assert b"dwell_s: 2" in plant.read_bytes()
    refused = DraftDesk(PlantFolder(plant, state), state, Checker(bad), work_by)
    refused.take(ANA, "ana")
    refused.set(ANA, DWELL, 3)
    assert refused.apply(ANA, "")["version"] is None and len(put) == 1


def test_a_plant_that_comes_with_arboleda_is_made_ones_own_before_it_is_changed(tmp_path: Path) -> None:
    at_work.keep(tmp_path, PlantFiles(plant="plant.yaml", contents={"plant.yaml": TEXT}), AT)
    folder = PlantFolder(None, tmp_path)
    desk = DraftDesk(folder, tmp_path, Checker(good))
    assert desk.take(ANA, "ana")["is_ours"] is False
    with pytest.raises(DraftRefused, match="make them your own first"):
        desk.set(ANA, DWELL, 2)
    with pytest.raises(DraftRefused, match="ana edits"):
        desk.own(BEN)
    assert desk.own(ANA)["is_ours"] is True and folder.file == tmp_path / "files" / "plant.yaml"
    desk.set(ANA, DWELL, 2)
    assert desk.keep(ANA, "")["version"] == 2
    assert b"dwell_s: 2" in folder.file.read_bytes() and (tmp_path / "files" / ".arboleda").is_dir()
    with pytest.raises(DraftRefused, match="your own already"):
        desk.own(ANA)
    assert "--plant" in PlantFolder(None, tmp_path).note
