"""Alarms of packages: people are told of them as of the plant's own, and of their end."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console

from arboleda.cli.screen import table
from arboleda.dashboard.page_state import PageState
from arboleda.model.sentence import Phrase, in_json
from arboleda.recorder.plain_data import plain, value_from
from arboleda.recorder.rows import PLANT, rows_of
from arboleda.rig.rig import Rig
from arboleda.runtime.build import Options, build
from arboleda.runtime.extensions.alarms import MOST, PackageAlarms
from arboleda.runtime.parts.alarms import AlarmsPart
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.testing import shipped
from arboleda.views import twin_view, view
from arboleda.views.chronicle import Chronicle
from arboleda.web.stream import changed
from arboleda.wire.status import ERROR, OK, WARN

NO_LINKS: dict[str, Any] = {"broker": None, "ros": None, "refused": {}, "standbys": []}

LATE = Phrase("orders.late", "order {order} is late")


@pytest.fixture
def alarms() -> PackageAlarms:
    return PackageAlarms()


def said(alarms: PackageAlarms) -> list[str]:
    return [str(each.said) for each in alarms.standing]


def test_an_alarm_stands_until_it_is_ended_whoever_raised_others(alarms: PackageAlarms) -> None:
    full = alarms.add("orders", "the shelf is full", cell="sis_a")
    alarms.add("camera", "no picture")
    assert said(alarms) == ["orders: the shelf is full", "camera: no picture"]
    full.end()
    full.end()
    assert said(alarms) == ["camera: no picture"]


def test_the_same_alarm_is_not_raised_twice_and_any_of_its_raisers_ends_it(alarms: PackageAlarms) -> None:
    alarms.add("orders", LATE(order=7))
    again = alarms.add("orders", LATE(order=7))
    alarms.add("orders", LATE(order=7), level="error")
    assert len(alarms.standing) == 2
    again.end()
    assert [each.level.value for each in alarms.standing] == ["error"]


def test_of_a_package_that_ends_none_the_last_ones_stand(alarms: PackageAlarms) -> None:
    alarms.add("camera", "no picture")
    for number in range(MOST + 5):
        alarms.add("orders", f"alarm {number}", part="orders.late")
    assert said(alarms)[:2] == ["camera: no picture", "orders: alarm 5"]
    assert len(alarms.standing) == MOST + 1
    alarms.end_all("orders.late")
    assert said(alarms) == ["camera: no picture"]


@pytest.mark.parametrize("sentence", ["", "  ", "\n"])
def test_an_alarm_says_something(alarms: PackageAlarms, sentence: str) -> None:
    with pytest.raises(ValueError, match="needs a sentence"):
        alarms.add("orders", sentence)
    with pytest.raises(ValueError, match="fatal"):
        alarms.add("orders", "late", level="fatal")
    assert alarms.standing == ()


def test_receivers_of_alarms_are_told_of_it_once_and_of_its_end(alarms: PackageAlarms) -> None:
    told: list[dict[str, Any]] = []
    part = AlarmsPart([], lambda cell, task: f"page of {cell}", lambda: alarms.standing)
    part._outboxes = [type("Outbox", (), {"put": staticmethod(told.append)})]  # type: ignore[list-item]
    rig = Rig(shipped("sis_a"))
    rig.watchers.append(lambda: part.stepped(rig.plant))
    raised = alarms.add("orders", "the shelf is full", cell="sis_a", level="error")
    rig.wait(3.0)
    (alarm,) = told
    assert {key: alarm[key] for key in ("kind", "package", "level", "cell", "sentence", "page")} == {
        "kind": "package_alarm",
        "package": "orders",
        "level": "error",
        "cell": "sis_a",
        "sentence": "orders: the shelf is full",
        "page": "page of sis_a",
    }
    raised.end()
    rig.wait(3.0)
    over = told[1]
    assert (over["kind"], over["alarm"], len(told)) == ("package_cleared", alarm["id"], 2)
    assert over["sentence"] == "this is over: orders: the shelf is full"


def test_diagnostics_tell_the_worst_of_them(alarms: PackageAlarms) -> None:
    assert alarms.diagnosis()[2:4] == (OK, "no alarm")
    alarms.add("camera", "no picture")
    assert alarms.diagnosis()[2] == WARN
    alarms.add("orders", "late", level="error")
    assert alarms.diagnosis()[2:4] == (ERROR, "camera: no picture; orders: late")


def test_the_time_line_a_record_and_whoever_follows_the_plant_have_it(alarms: PackageAlarms) -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    chronicle, before = Chronicle(), {**rig.snapshot(), **alarms.rows()}
    chronicle.see(before, 0.0)
    raised = alarms.add("orders", LATE(order=7), cell="sis_a")
    there = {**rig.snapshot(), **alarms.rows()}
    chronicle.see(there, 1.0)
    raised.end()
    chronicle.see({**rig.snapshot(), **alarms.rows()}, 2.0)
    events = [each for each in chronicle.events if each["kind"] == "alarm"]
    assert [(each["cell"], each["subject"], each["what"]) for each in events] == [
        ("sis_a", "orders", "raised"),
        ("sis_a", "orders", "over"),
    ]
    assert [kind for kind, _ in changed(before, there)] == ["plant"]
    rows = dict(rows_of(there, twin_view.positions(rig.plant)))
    (kept,) = value_from(plain(rows[PLANT]))["alarms"]
    assert (kept["package"], str(kept["sentence"])) == ("orders", "order 7 is late")


def test_the_page_shows_it_and_an_error_is_heard(alarms: PackageAlarms) -> None:
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    story = PageState(view.layout(rig.plant.model), [])

    def face() -> dict[str, Any]:
        story.see({**rig.snapshot(), **alarms.rows()}, 0.0)
        return story.face("en", NO_LINKS)

    assert face()["rows/alarms"] == [] and face()["text/title"] == ["arboleda", "well"]
    alarms.add("camera", "no picture", cell="sis_a")
    shown = face()
    (id,) = shown["rows/alarms"]
    assert shown[f"row/alarms/{id}"] == {"state": "warning", "texts": ["camera", "sis_a", "no picture"]}
    assert shown["text/needs"] == ["", ""] and shown["text/title"][1] == "well"
    alarms.add("orders", "late", level="error")
    assert face()["text/needs"] == ["alarm/2", ""]
    assert face()["text/title"] == ["⚠ orders: late - arboleda", "trouble"]


def test_a_plant_that_runs_tells_it_to_all_screens(tmp_path: Path) -> None:
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    raised = app.offers.need(PackageAlarms).add("orders", "the shelf is full", cell="sis_a")
    app.plant.loop.turn()
    told = json.loads(json.dumps(app.offers.need(LocalPlant).latest(), default=in_json))
    alarm = {"id": 1, "package": "orders", "cell": "sis_a", "level": "warning"}
    assert told["alarms"] == [alarm | {"sentence": "the shelf is full"}]
    console = Console(file=io.StringIO(), width=80)
    console.print(table(told))
    assert "orders: the shelf is full" in console.file.getvalue()  # type: ignore[attr-defined]
    raised.end()
    assert app.plant.screens.snapshot()["alarms"] == []
    app.stop()
