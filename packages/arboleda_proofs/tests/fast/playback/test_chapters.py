"""Chapters of reports in a record: kept by whoever writes it, read again, copied, never in the way of it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from tests.threads import AtTheEnd, stand_in
from tests.unit.recorder.recorded import DEFAULT, beginning_of

from arboleda.recorder import recorder
from arboleda.recorder.chapter import Chapter, chapter
from arboleda.recorder.copying import as_mcap
from arboleda.recorder.files import parts_in
from arboleda.recorder.reader import alone, opened
from arboleda.recorder.recorder import MOST_CHAPTERS, Recorder
from arboleda.recorder.writing import Writing
from arboleda.testing import shipped
from arboleda_proofs.playback.chapters import chapters_in

A_PNG = b"\x89PNG\r\n\x1a\n\x00\xff"
MADE = chapter("lot", "camera", "Seen", "two\nlines", [("a", 1)], A_PNG)


def kept(folder: Path, *chapters: Chapter, least_free: int = 0) -> Recorder:
    """The writer of a record that was given these chapters, at its end."""
    made = Recorder(Writing(folder, beginning_of(shipped("sis_a")), DEFAULT, least_free=least_free))
    made.start()
    for each in chapters:
        made.add(each)
    made.stop()
    return made


def found(folder: Path, task: str = "lot") -> list[Chapter]:
    return chapters_in([part.path for part in parts_in(folder)], task)


@pytest.fixture(autouse=True)
def _no_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(recorder, AtTheEnd, monkeypatch)


def test_the_chapters_of_a_task_come_back_in_their_order_and_no_others(tmp_path: Path) -> None:
    kept(tmp_path, MADE, replace(MADE, task="lot2"), replace(MADE, title="Later", picture=b""))
    first, second = found(tmp_path)
    assert replace(first, unix_ns=0) == MADE and first.unix_ns > 0
    assert (second.title, second.picture, second.picture_type) == ("Later", b"", "")
    assert found(tmp_path, "lo") == []


def test_a_copy_has_them_also_those_from_before_the_first_message(tmp_path: Path) -> None:
    kept(tmp_path, MADE)
    (part,) = parts_in(tmp_path)
    assert opened(part.path).first.beginning.plant == "arboleda"
    as_mcap(alone(part.path), tmp_path / "copy.mcap", (1,))
    (copied,) = chapters_in([tmp_path / "copy.mcap"], "lot")
    assert replace(copied, unix_ns=0) == MADE


def test_a_torn_file_has_those_before_the_tear(tmp_path: Path) -> None:
    kept(tmp_path, MADE, replace(MADE, title="Torn"))
    (part,) = parts_in(tmp_path)
    content = part.path.read_bytes()
    part.path.write_bytes(content[: content.rindex(b"chapter/lot/", 0, content.index(b'"Torn"')) + 20])
    assert [each.title for each in found(tmp_path)] == ["Seen"]


def test_what_no_plant_writes_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Chapter, "data", lambda self: b'{"picture": "?"}' if self.title == "Bad" else b"[]")
    kept(tmp_path, MADE, replace(MADE, title="Bad"))
    assert found(tmp_path) == []


def test_too_many_at_once_are_dropped_and_the_record_goes_on(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    made = kept(tmp_path, *[MADE] * (MOST_CHAPTERS + 1))
    assert made.trouble == "" and len(found(tmp_path)) == MOST_CHAPTERS
    assert "a chapter of camera for the report of lot is lost: 50 others wait" in caplog.text
