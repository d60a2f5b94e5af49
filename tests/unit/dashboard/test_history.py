"""The tasks of all starts as the page shows them."""

from __future__ import annotations

import json
import time
from dataclasses import replace

from arboleda.core.intake import CUT_OFF
from arboleda.dashboard.faces.history import face
from arboleda.dashboard.wording import words
from arboleda.model.messages import Check
from arboleda.model.task import UNCHECKED
from arboleda.store.task_rows import TaskRow

NOW = time.mktime((2026, 5, 4, 12, 0, 0, 0, 0, -1))
CUT = TaskRow(
    number=7,
    id="lot1",
    text="sis_a 0B 7",
    cell="sis_a",
    recipe="storage",
    state="failed",
    reason="interrupted",
    sentence=str(CUT_OFF()),
    said=json.dumps(CUT_OFF().data()),
    accepted_s=NOW - 86400,
    started_s=NOW - 60,
    ended_s=NOW - 50,
    asked_by="http",
    attempts=2,
)


def texts(row: TaskRow, language: str = "en") -> list[str]:
    return face([row], words(language), NOW)[f"row/history/{row.number}"]["texts"]


def test_a_task_has_who_asked_its_times_how_often_it_was_tried_and_why_it_failed() -> None:
    state, text, accepted, asked_by, ended, took, attempts, why, id = texts(CUT)
    assert (asked_by, attempts) == ("HTTP", "2")
    assert (state, text, accepted, ended, took, id) == (
        "failed",
        "sis_a 0B 7",
        "2026-05-03 12:00:00",
        "11:59:10",
        "10 s",
        "#lot1",
    )
    assert why == f"Interrupted: {CUT_OFF()}"


def test_why_it_failed_is_said_in_the_language_of_the_page() -> None:
    assert "la planta terminó mientras esta estaba en marcha" in texts(CUT, "es")[7]


def test_what_was_kept_as_text_only_is_shown_as_it_is() -> None:
    assert texts(replace(CUT, said="no data"), "es")[7].endswith(str(CUT_OFF()))


def test_a_task_that_waits_has_neither_end_nor_cause() -> None:
    waits = replace(CUT, state="queued", reason=None, sentence=None, said=None, started_s=None, ended_s=None)
    assert texts(waits)[4:8] == ["", "", "2", ""]


def test_a_done_task_says_what_of_it_nobody_confirmed() -> None:
    remark = UNCHECKED[Check.RELEASE,]()
    done = replace(CUT, state="done", reason=None, sentence=str(remark), said=json.dumps(remark.data()))
    assert texts(done)[7] == "not checked: whether the part was let go of"
    assert texts(done, "es")[7] == "sin comprobar: si la pieza se soltó"


def test_what_an_older_version_kept_has_neither_who_asked_nor_attempts() -> None:
    old = texts(replace(CUT, asked_by=None, attempts=0))
    assert (old[3], old[6]) == ("", "")
