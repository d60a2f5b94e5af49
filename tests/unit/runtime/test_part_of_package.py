"""A part of a package gives tasks, follows them, keeps a table and shows values."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, cast

import pytest
from tests.added_package import install
from tests.in_process import Caller

from arboleda.extension import ArboledaError, Refused
from arboleda.host.packages import registered
from arboleda.host.pieces import piece_of
from arboleda.runtime.build import App, Options, build
from arboleda.runtime.extensions import table
from arboleda.runtime.extensions.telling import Telling
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.store.task_rows import TaskQuery
from arboleda.testing import shipped
from arboleda.web.api import make_app

CODE = """
from arboleda.extension import Part


class Orders(Part):
    def start(self):
        self.told = []
        self.plant.on_task(self.follow)
        {start}

    def follow(self, task):
        {follow}
        self.told.append((task.id, task.state))

    def routes(self):
        api = super().routes()

        @api.get("/api/orders")
        async def orders() -> list[list[str]]:
            return self.told

        return api
"""
ALL = TaskQuery()
Made = Callable[..., tuple[App, Any]]


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Made]:
    """Makes a plant with the part, which has started; the plant's steps are taken by hand."""
    monkeypatch.syspath_prepend(tmp_path / "site")
    apps: list[App] = []

    def make(*, start: str = "pass", follow: str = "pass") -> tuple[App, Any]:
        if not (tmp_path / "site").exists():
            code = CODE.format(start=start, follow=follow)
            install(tmp_path / "site", "orders", code, what="Orders")
        options = Options(state_dir=tmp_path / "state", page=False)
        apps.append(build(shipped("sis_a"), {"orchestrator"}, options))
        part: Any = apps[-1].offers.ask(sys.modules["orders"].Orders)
        part.start()
        return apps[-1], part

    yield make
    for app in apps:
        app.stop()
    sys.modules.pop("orders", None)


def turn(app: App) -> None:
    """A step of the plant; then its listeners are told."""
    app.plant.loop.turn()
    (telling,) = (each for each in app.parts if isinstance(each, Telling))
    while telling.turn():
        pass


def left_out(app: App) -> list[str]:
    return [note for note in app.notes if "goes on without" in note]


def test_it_gives_a_task_and_is_told_of_it(made: Made) -> None:
    app, part = made()
    answer = part.plant.submit("sis_a 0B 7 #lot")
    turn(app)
    assert answer.result(0).state == "queued" and ("lot", "queued") in part.told
    cancelled = part.plant.cancel("lot")
    turn(app)
    assert cancelled.result(0).verb == "cancel" and part.told[-1] == ("lot", "cancelled")
    assert part.plant.task("lot").has_ended and [each.id for each in part.plant.tasks()] == ["lot"]


def test_a_task_says_which_package_gave_it(made: Made) -> None:
    app, part = made()
    part.plant.submit("sis_a 0B 7 #lot")
    turn(app)
    (row,) = app.offers.need(LocalPlant).history(ALL)
    assert row.asked_by == "extension orders"


def test_who_asks_again_for_a_task_is_answered_and_nobody_is_told(made: Made) -> None:
    app, part = made()
    for _ in range(2):
        part.plant.submit("sis_a 0B 7 #lot")
        turn(app)
    part.plant.cancel("lot")
    turn(app)
    again = part.plant.submit("sis_a 0B 7 #lot")
    turn(app)
    assert again.result(0).state == "cancelled"
    assert part.told == [("lot", "queued"), ("lot", "cancelled")]


def test_callbacks_of_answers_are_called_outside_of_the_threads_of_the_plant(made: Made) -> None:
    app, part = made()
    answers: list[Any] = []
    part.plant.submit("sis_a 0B 7 #lot").add_done_callback(lambda done: answers.append(done.result()))
    app.plant.loop.turn()
    assert answers == []
    turn(app)
    assert [each.id for each in answers] == ["lot"]


def test_what_is_refused_says_why(made: Made) -> None:
    app, part = made()
    no_task, no_act = part.plant.submit("sis_z 0B 7 #mine"), part.plant.cancel("lot")
    turn(app)
    assert "sis_z" in no_task.result(0).sentence and no_task.result(0).state == "refused"
    assert no_task.result(0).id == "mine" and ("mine", "refused") in part.told
    with pytest.raises(Refused, match="lot"):
        no_act.result(0)


def test_it_sees_the_devices(made: Made) -> None:
    _, part = made()
    devices = part.plant.devices()
    assert {each.cells for each in devices.values()} == {("sis_a",)}
    assert [(each.driver, each.settings) for each in devices.values()] == [("", None)] * len(devices)


def test_it_asks_and_tells_people_under_the_name_of_its_package(
    made: Made, caplog: pytest.LogCaptureFixture
) -> None:
    app, part = made()
    alarm = part.plant.alarm("the shelf is full", cell="sis_a", level="error")
    answer, heard = part.plant.ask("Is the lot good?", ("good", "bad")), []
    answer.add_done_callback(lambda done: heard.append(done.result()))
    turn(app)
    seen = part.plant.snapshot()
    assert [(each["package"], each["level"]) for each in seen["alarms"]] == [("orders", "error")]
    assert [(each["package"], each["text"]) for each in seen["questions"]] == [("orders", "Is the lot good?")]
    alarm.end()
    part.plant.operate("answer", "orders", answer="good")
    app.plant.loop.turn()
    assert answer.result(0) == "good" and heard == []
    turn(app)
    assert heard == ["good"] and part.plant.snapshot()["alarms"] == []
    part.plant.report("lot", "Seen", "sharp")
    assert "orders writes into the reports of tasks; this plant writes no record" in caplog.text


def test_its_routes_are_in_the_api(made: Made) -> None:
    app, part = made()
    part.plant.submit("sis_a 0B 7 #lot")
    turn(app)
    told = Caller(make_app(app.offers.need(LocalPlant))).get("/api/orders").json()
    assert ["lot", "queued"] in told


def test_what_it_shows_is_among_the_links(made: Made) -> None:
    app, part = made()
    part.plant.show(open=3)
    part.plant.show(rows=[{"id": "lot"}])
    assert app.links()["orders"] == {"open": 3, "rows": [{"id": "lot"}]}
    with pytest.raises(TypeError):
        part.plant.show(open=object())
    assert app.links()["orders"]["open"] == 3


def test_a_listener_that_breaks_is_left_out_alone(made: Made) -> None:
    app, part = made(follow="raise ValueError('the shelf is full')")
    for id in ("lot", "next"):
        part.plant.submit(f"sis_a 0B 7 #{id}")
        turn(app)
    assert left_out(app) == [
        "Arboleda goes on without the listener Orders.follow of orders 1: ValueError: the shelf is full"
    ]
    assert Caller(make_app(app.offers.need(LocalPlant))).get("/api/orders").json() == []


def test_a_part_that_is_left_out_leaves_no_question_and_its_routes_say_why(made: Made) -> None:
    app, part = made()
    part.plant.alarm("the shelf is full")
    asked, assembly = part.plant.ask("Go on?"), cast(Any, app.offers)
    (point,) = (each for each in registered("arboleda.parts") if each.name == "orders")
    with assembly.pieces.calling(piece_of(point, "the part Orders")):
        raise ValueError("no shelf")
    why = ["Arboleda goes on without the part Orders of orders 1: ValueError: no shelf"]
    turn(app)
    assert left_out(app) == why and asked.cancelled()
    assert part.plant.snapshot()["alarms"] == part.plant.snapshot()["questions"] == []
    part.plant.submit("sis_a 0B 7 #lot")
    turn(app)
    assert part.told == []
    answer = Caller(make_app(assembly.need(LocalPlant), pieces=assembly.pieces)).get("/api/orders")
    assert (answer.status_code, answer.json()) == (503, {"sentence": why[0]})


BROKEN = (
    CODE.format(start="pass", follow="pass")
    + """
    def __init__(self, *given):
        raise ValueError("no shelf")
"""
)


@pytest.mark.parametrize(
    ("code", "piece"), [("raise ValueError('no shelf')", "parts"), (BROKEN, "part Orders")]
)
def test_a_part_that_is_not_made_has_no_routes_and_the_answer_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, piece: str
) -> None:
    monkeypatch.syspath_prepend(tmp_path / "site")
    install(tmp_path / "site", "orders", code, what="Orders")
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    assembly = cast(Any, app.offers)
    asked = Caller(make_app(assembly.need(LocalPlant), pieces=assembly.pieces)).get("/api/orders")
    app.stop()
    sys.modules.pop("orders", None)
    assert (asked.status_code, asked.json()["sentence"]) == (
        404,
        "There is nothing here; /api/docs lists what there is; "
        f"Arboleda goes on without the {piece} of orders 1: ValueError: no shelf",
    )


def test_it_is_told_outside_of_the_steps_of_the_plant(made: Made) -> None:
    app, part = made()
    answer = part.plant.submit("sis_a 0B 7 #lot")
    app.plant.loop.turn()
    assert answer.result(0).state == "queued" and part.told == []
    turn(app)
    assert part.told[0] == ("lot", "queued")


def test_a_table_is_there_after_a_restart(made: Made) -> None:
    app, part = made()
    part.plant.table().put({"lot": {"amount": 3}, "old": 1})
    part.plant.table().put({"old": None})
    part.plant.table("prices").put({"lot": 2.5})
    app.stop()
    _, again = made()
    assert again.plant.table().rows() == {"lot": {"amount": 3}}
    assert again.plant.table("prices").get("lot") == 2.5 and again.plant.table().get("old", 7) == 7


def test_rows_that_are_no_plain_data_are_refused_whole(made: Made) -> None:
    _, part = made()
    with pytest.raises(TypeError):
        part.plant.table().put({"lot": 1, "thing": object()})
    assert part.plant.table().rows() == {}


def test_what_the_plant_does_not_write_is_said(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    """As where its memory has failed: it makes no step more."""
    monkeypatch.setattr(table, "LOOKS", 1)
    app, part = made()
    monkeypatch.setattr(app.plant.loop.__class__, "running", True)
    with pytest.raises(ArboledaError, match="has not written this"):
        part.plant.table().put({"lot": 1})
    assert part.plant.table().rows() == {}
    monkeypatch.undo()


def test_a_name_that_the_plant_uses_itself_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.syspath_prepend(tmp_path / "site")
    install(tmp_path / "site", "memory", CODE.format(start="pass", follow="pass"), what="Orders")
    app = build(shipped("sis_a"), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.stop()
    sys.modules.pop("memory", None)
    (said,) = left_out(app)
    assert "Arboleda itself shows memory on the page: register it under another name" in said


def test_its_folder_is_in_the_state_directory(made: Made, tmp_path: Path) -> None:
    _, part = made()
    assert part.plant.folder == tmp_path / "state/extensions/orders" and part.plant.folder.is_dir()
