"""The versions of a plant's files as the page shows them."""

from __future__ import annotations

from typing import Any

from arboleda.dashboard.wording import words
from arboleda_make.page import version_rows

AT = "2026-11-25T20:39:13+00:00"


def listed(number: int | None) -> dict[str, Any]:
    rows = [
        {"number": each, "at": AT, "by": by, "note": note, "changes": changes, "is_at_work": each == number}
        for each, by, note, changes in (
            (1, "", "as the plant was started", []),
            (2, "ana", "", ["timing.dwell_s: from 1 to 2"]),
        )
    ]
    cells = [
        {"cell": "lab", "version": 2, "following": None, "when": "now"},
        {"cell": "line", "version": 1, "following": 2, "when": "when task t-1-1 has ended"},
    ]
    restart = {"by": "", "can": False}
    return {"at_work": {"number": number, "at": AT}, "versions": rows, "cells": cells, "restart": restart}


def test_the_last_version_comes_first_and_the_one_at_work_has_no_way_back() -> None:
    face = version_rows.face(listed(2), words("en"))
    assert face["now"] == "Version 2 is at work since 2026-11-25 20:39:13 UTC."
    assert [each["back"] for each in face["rows"]] == ["", "Back to version 1"]
    assert face["rows"][0]["title"] == "Version 2, 2026-11-25 20:39:13 UTC, ana"
    assert [each["lines"] for each in face["rows"]] == [
        ["timing.dwell_s: from 1 to 2"],
        ["as the plant was started"],
    ]


def test_a_cell_that_takes_it_later_is_named_in_each_language() -> None:
    assert version_rows.face(listed(2), words("en"))["cells"] == [
        "line takes version 2 once its task has ended."
    ]
    assert version_rows.face(listed(2), words("es"))["cells"] == [
        "line adopta la versión 2 en cuanto termine su tarea."
    ]


def test_what_no_version_has_is_said_to_be_of_the_start() -> None:
    face = version_rows.face(listed(None), words("en"))
    assert face["now"].startswith("At work is what the plant was started with at 2026")
    assert all(each["back"] for each in face["rows"])


def test_a_restart_is_offered_where_it_can_be_had_and_called_off_where_somebody_wants_it() -> None:
    assert version_rows.face(listed(2), words("en"))["restart"] is None
    offered = version_rows.face(listed(2) | {"restart": {"by": "", "can": True}}, words("en"))["restart"]
    assert (offered["button"], offered["wanted"]) == ("Restart once all cells rest", False)
    wanted = version_rows.face(listed(2) | {"restart": {"by": "ana", "can": True}}, words("en"))["restart"]
    assert wanted["said"].startswith("The plant restarts once all its cells rest, as ana wants.")
    assert (wanted["button"], wanted["wanted"]) == ("Do not restart", True)
