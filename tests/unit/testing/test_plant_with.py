"""A test of a package is short: `plant_with` makes a plant with its parts, whose time is moved by hand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import pytest
from tests.in_process import without_threads

from arboleda.extension import ArboledaError, Part, Role
from arboleda.model.plant_model import Link
from arboleda.testing import shipped
from arboleda.testing.plugin import MakePlantWith

TASK = "sis_a 0B 7 #lot"


@dataclass(frozen=True, kw_only=True)
class OrderSettings:
    cell: str
    most: int = 2


class Orders(Part, settings=OrderSettings):
    settings: OrderSettings

    def start(self) -> None:
        self.table = self.plant.table()
        self.plant.on_task(self.follow)

    def follow(self, task: Any) -> None:
        self.table.put({task.id: task.state})
        self.plant.show(done=[id for id, state in self.table.rows().items() if state == "done"])
        if task.id == "lot" and task.has_ended:
            self.plant.submit(f"{self.settings.cell} 0B 8 #next")

    def routes(self) -> Any:
        api = super().routes()

        @api.post("/api/orders")
        async def add(text: str) -> str:
            """Give a task."""
            return self.plant.submit(text).result().state

        return api


def orders(plant_with: MakePlantWith) -> Any:
    return plant_with(Orders, settings=[OrderSettings(cell="sis_a")], plant=shipped("sis_a"))


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    without_threads(monkeypatch)


def test_tasks_are_done_and_the_part_follows(plant_with: MakePlantWith) -> None:
    plant = orders(plant_with)
    assert plant.post(f"/api/orders?text={TASK.replace(' ', '%20').replace('#', '%23')}") == "queued"
    assert plant.wait(900, until=lambda: plant.shown(Orders).get("done") == ["lot", "next"])


def test_a_device_that_is_reached_in_another_way_is_a_virtual_board(plant_with: MakePlantWith) -> None:
    model = shipped("sis_a")
    cells = tuple(cell.with_robots(lambda robot: replace(robot, link=Link.ROS)) for cell in model.cells)
    plant = plant_with(Orders, settings=[OrderSettings(cell="sis_a")], plant=replace(model, cells=cells))
    plant.submit(TASK)
    assert plant.wait(900, until=lambda: plant.shown(Orders).get("done") == ["lot"])


def test_rows_are_there_after_a_restart(plant_with: MakePlantWith) -> None:
    plant = orders(plant_with)
    plant.submit(TASK)
    plant.restart()
    assert plant.part(Orders).table.get("lot") in ("queued", "running")


def test_a_route_refuses_who_may_not(plant_with: MakePlantWith) -> None:
    with pytest.raises(ArboledaError, match="operator"):
        orders(plant_with).post("/api/orders?text=x", role=Role.VIEWER)


def test_an_answer_has_its_status(plant_with: MakePlantWith) -> None:
    plant = orders(plant_with)
    assert plant.response("POST", "/api/orders?text=x", role=Role.VIEWER).status_code == 403
    assert plant.response("GET", "/api/nothing").status_code == 404
    assert plant.response("GET", "/api/plant").status_code == 200


def test_what_parts_tell_and_ask_people_is_seen(plant_with: MakePlantWith) -> None:
    plant = orders(plant_with)
    part = plant.part(Orders)
    part.plant.alarm("the shelf is full")
    part.plant.report("lot", "Invoice", "3 pieces")
    answer = part.plant.ask("Ship it?")
    assert (plant.alarms, plant.questions) == (["the shelf is full"], ["Ship it?"])
    assert [each.title for each in plant.chapters] == ["Invoice"]
    seen = plant.get("/api/plant")
    assert [each["text"] for each in seen["questions"]] == ["Ship it?"]
    assert [each["package"] for each in seen["alarms"]] == ["orders"] and seen["chapters"] == ["lot"]
    plant.answer("yes")
    assert answer.result(0) == "yes" and plant.questions == []
    with pytest.raises(ArboledaError, match="no part asks"):
        plant.answer("yes")


def test_what_a_part_raises_ends_the_test(plant_with: MakePlantWith) -> None:
    plant = orders(plant_with)
    plant.part(Orders).table = None
    with pytest.raises(AttributeError):
        plant.submit(TASK)


def test_settings_that_are_missing_are_named(plant_with: MakePlantWith) -> None:
    with pytest.raises(ArboledaError, match="Orders needs settings: give plant_with one OrderSettings"):
        plant_with(Orders, plant=shipped("sis_a"))
