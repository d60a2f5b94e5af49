"""Devices, arms and tools that cells share, in the plant file: what is read, and how screens show them."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from arboleda.cli.screen import table
from arboleda.core.plant import Plant
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.views import view
from arboleda.views.chronicle import Chronicle
from arboleda.views.view import devices_once

from ...plants import plant_text, written

TEXT = plant_text(__file__, "shared_devices")


def load(tmp_path: Path, text: str = TEXT) -> PlantModel:
    return loader.load(written(tmp_path, text), recipes=False)


def test_one_device_is_in_two_cells_in_roles_of_their_own(tmp_path: Path) -> None:
    model = load(tmp_path)
    assert model.shared == ("lift", "porter")
    assert model.cell("below").roles["lift"] is model.cell("above").roles["hoist"]
    assert [cell.name for cell in model.cells_of["lift"]] == ["below", "above"]
    assert list(model.robots) == ["lamp_1", "lift", "porter", "lamp_2"]
    assert model.cell("above").own == ("lamp_2",)


def test_screens_show_it_once_and_who_has_it(tmp_path: Path) -> None:
    plant = Plant(load(tmp_path), epoch=1, now=0.0)
    plant.zones.acquire("above", frozenset({"lift"}))
    snapshot = view.snapshot(plant)
    rows = {row["name"]: row["holder"] for row in snapshot["robots"]}
    assert len(snapshot["robots"]) == len(rows)
    assert rows == {"lamp_1": None, "lift": "above", "porter": None, "lamp_2": None}
    assert {"zone": "lift", "state": "held", "robot": "above", "waiting": []} in snapshot["zones"]
    once = [(cell, device["name"]) for cell, device in devices_once(snapshot["cells"])]
    assert once == [("below", "lamp_1"), ("below", "lift"), ("below", "porter"), ("above", "lamp_2")]
    out = StringIO()
    Console(file=out, width=200).print(table(snapshot))
    (line,) = [each for each in out.getvalue().splitlines() if " lift " in each and "below, above" in each]
    assert "held by above" in line


def test_the_time_line_tells_once_that_it_is_not_heard(tmp_path: Path) -> None:
    snapshot = view.snapshot(Plant(load(tmp_path), epoch=1, now=0.0))
    online = {**snapshot, "robots": [{**each, "online": True} for each in snapshot["robots"]]}
    chronicle = Chronicle()
    chronicle.see(online, 0.0)
    before = len(chronicle.events)
    chronicle.see(snapshot, 1.0)
    told = [each["subject"] for each in list(chronicle.events)[before:]]
    assert told.count("lift") == 1


ROBOTS = plant_text(__file__, "shared_robots")


def with_robots(tmp_path: Path, text: str = ROBOTS) -> PlantModel:
    return loader.load(written(tmp_path, text), recipes=False)


def test_each_cell_has_targets_of_its_own_for_an_arm_that_it_shares_with_its_tool(tmp_path: Path) -> None:
    model = with_robots(tmp_path)
    left, right = model.cells
    assert model.shared == ("robot", "jaw")
    assert [list(cell.reach["robot"].targets) for cell in model.cells] == [["home", "feed"], ["home", "vise"]]
    assert [cell.reach["robot"].hand.name for cell in model.cells] == ["jaw", "jaw"]
    assert left.reach["robot"].zones == right.reach["robot"].zones == {"table"}
    assert left.together({"robot"}) == right.together({"jaw"}) == {"robot", "jaw"}


def test_paths_and_handovers_of_a_shared_robot_are_refused(tmp_path: Path) -> None:
    text = ROBOTS.replace(
        "    targets:\n      home: {arm",
        "    handover: {taker: arm, giver: lamp, at: vise}\n    targets:\n      home: {arm",
    )
    with pytest.raises(ConfigError) as refusal:
        with_robots(tmp_path, text)
    rule = "cells.right.handover.taker: robot is shared; a handover is between two robots of one cell"
    assert any(rule in each for each in refusal.value.problems), refusal.value.problems
