"""The page on many plants shows each by its worst cell, trouble first, and what all of them come to."""

from __future__ import annotations

from typing import Any

from arboleda.dashboard.wording import words
from arboleda.model.sentence import OWN
from arboleda_fleet.site.face import face, whole_oee
from arboleda_fleet.site.side import LastSeenPlant

SILENT = OWN(text="no answer in 2.5 s")


def cell(state: str = "idle", **said: Any) -> dict[str, Any]:
    return {"name": "sis_a", "state": state, "not_ready": None, "held_by": None, "advice": [], **said}


def plant(name: str, *cells: dict[str, Any], tasks: tuple[str, ...] = (), **more: Any) -> LastSeenPlant:
    snapshot = {"cells": list(cells), "tasks": [{"state": each} for each in tasks]}
    return LastSeenPlant(**{"name": name, "url": f"http://{name}:8080", "snapshot": snapshot, **more})


def figures(oee: float | None, planned_s: float, done: int = 0, failed: int = 0) -> dict[str, Any]:
    return {"oee": oee, "planned_s": planned_s, "done": done, "failed": failed}


def test_trouble_comes_first_and_the_silent_before_it() -> None:
    plants = [
        plant("idle", cell()),
        plant("works", cell("execute")),
        plant("held", cell("execute"), cell("held", held_by="sis_a is held (why)")),
        plant("stopped", cell("aborted")),
        plant("silent", cell(), silent=SILENT),
        plant("blocked", cell(not_ready="ra1 is offline")),
    ]
    assert face(plants, words("en"))["rows/plants"] == [
        "silent",
        "stopped",
        "held",
        "blocked",
        "works",
        "idle",
    ]


def test_a_row_says_what_is_the_matter_and_leads_to_the_plants_own_page() -> None:
    row = face([plant("a", cell("held", held_by="sis_a is held (why)"))], words("es"))["row/plants/a"]
    assert row["texts"][:3] == ["retenida", "a", "sis_a: sis_a is held (why)"]
    assert row["link"] == {"column": 1, "href": "http://a:8080"}
    assert [(act["act"], act["of"]) for act in row["acts"]] == [("stop", "a")]


def test_of_a_silent_plant_nothing_old_is_shown_and_it_can_still_be_told_to_stop() -> None:
    seen = plant("a", cell("held", held_by="x"), tasks=("running",), silent=SILENT)
    row = face([seen], words("en"))["row/plants/a"]
    assert row["texts"] == ["no answer", "a", "no answer in 2.5 s", "", "", "-"]
    assert row["acts"]


def test_of_a_silent_plant_nothing_is_counted() -> None:
    seen = plant("a", cell(), silent=SILENT, oee=[figures(None, 0.0), figures(0.5, 10.0, 3)])
    told = face([seen], words("en"))
    assert told["row/plants/a"]["texts"][3:] == ["", "", "-"]
    assert told["text/sum"] == ["plants: 1 · no answer: 1", "offline"]


def test_an_address_that_is_none_of_the_web_is_no_link() -> None:
    seen = plant("a", cell(), url="javascript:alert(1)")
    assert face([seen], words("en"))["row/plants/a"]["link"] is None


def test_the_sum_counts_plants_tasks_and_oee_over_all() -> None:
    plants = [
        plant("a", cell("execute"), tasks=("running", "queued", "done"), oee=[figures(0.9, 100.0, 8, 1)]),
        plant("b", cell(), oee=[figures(0.6, 200.0, 4, 1), figures(None, 50.0)]),
        plant("c", cell(), silent=SILENT),
    ]
    said, state = face(plants, words("en"))["text/sum"]
    assert state == "offline"
    assert said.split(" · ") == [
        *("plants: 3", "idle: 1", "working: 1", "no answer: 1"),
        *("1 running, 1 waiting", "12 done, 2 failed", "OEE 70 %"),
    ]
    assert face(plants, words("en"))["text/title"] == ["⚠ c - Site", "trouble"]


def test_an_oee_that_nobody_can_say_is_none() -> None:
    assert whole_oee([]) is None
    assert whole_oee([figures(None, 10.0), figures(0.5, 0.0)]) is None


def test_who_stands_by_is_said() -> None:
    row = face([plant("a", cell(), standbys=1)], words("en"))["row/plants/a"]
    assert row["texts"][2] == "standing by: 1"
