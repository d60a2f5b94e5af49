"""Chapters of reports in a record: kept by whoever writes it, read again, copied, never in the way of it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.threads import AtTheEnd, stand_in

from arboleda.recorder import recorder
from arboleda.recorder.chapter import JPEG, LARGEST, LONGEST_TEXT, MOST_ROWS, PNG, SVG, Chapter, chapter
from arboleda.recorder.recorder import Recorder
from arboleda.recorder.writing import Writing
from arboleda.runtime.extensions.chapters import Chapters
from arboleda.testing import shipped

from .recorded import DEFAULT, beginning_of

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


@pytest.fixture(autouse=True)
def _no_thread(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(recorder, AtTheEnd, monkeypatch)


def test_who_wants_to_know_is_told_once_a_chapter_is_written(tmp_path: Path) -> None:
    made = Recorder(Writing(tmp_path, beginning_of(shipped("sis_a")), DEFAULT, least_free=0))
    told: list[str] = []
    made.wrote.append(told.append)
    made.start()
    made.add(MADE)
    assert told == []
    made.stop()
    assert told == ["lot"]


def test_on_a_full_disk_a_chapter_is_lost_and_nothing_is_raised(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    made = kept(tmp_path, MADE, least_free=10**18)
    made.add(MADE)
    assert "is lost: the disk has less than" in caplog.text


def test_a_plant_without_a_record_says_once_that_nothing_is_kept(caplog: pytest.LogCaptureFixture) -> None:
    chapters = Chapters(lambda: None)
    chapters.add("camera", "lot", "Seen")
    chapters.add("camera", "lot", "Seen")
    assert len(caplog.records) == 1 and "writes no record" in caplog.text
    assert chapters.rows() == {"chapters": []}


def test_screens_know_the_tasks_that_chapters_were_written_about() -> None:
    written: list[Chapter] = []
    chapters = Chapters(lambda: SimpleNamespace(add=written.append))
    for task in ("lot", "next", "lot"):
        chapters.add("camera", task, "Seen")
    assert chapters.rows() == {"chapters": ["lot", "next"]} and len(written) == 3


@pytest.mark.parametrize(
    ("picture", "kind"),
    [
        (A_PNG, PNG),
        (b"\xff\xd8\xff\xe0", JPEG),
        (b"<svg xmlns='http://www.w3.org/2000/svg'/>", SVG),
        (b'\xef\xbb\xbf<?xml version="1.0"?>\n<!-- made -->\n<svg/>', SVG),
    ],
)
def test_the_type_of_a_picture_is_known_by_its_first_bytes(picture: bytes, kind: str) -> None:
    assert chapter("lot", "camera", "Seen", picture=picture).picture_type == kind


@pytest.mark.parametrize(
    ("picture", "why"),
    [
        (b"GIF89a", "a picture is PNG, JPEG or SVG; this is none of them"),
        (b"<html><script>1</script></html>", "none of them"),
        (A_PNG + b"\0" * LARGEST, "a picture of 2.0 MB is too large: at most 2 MB"),
    ],
)
def test_another_picture_is_refused_at_once(picture: bytes, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        chapter("lot", "camera", "Seen", picture=picture)


def test_a_chapter_is_cut_to_what_a_report_has_room_for_and_has_a_title() -> None:
    made = chapter("lot", "camera", "Seen", "x" * 20_000, [[1.5, None]] * 1000)
    assert len(made.text) == LONGEST_TEXT and len(made.rows) == MOST_ROWS
    assert made.rows[0] == ("1.5", "None")
    with pytest.raises(ValueError, match="needs a title"):
        chapter("lot", "camera", " ")
