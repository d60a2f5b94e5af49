"""The page for readers of the original description says the figures of the shipped plant."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from arboleda.testing import shipped
from arboleda_bringup.table import root_link

HOW_TO = Path(__file__).parents[2] / "docs/how-to"
PAGES = ("original-description.md", "original-description.es.md")


@pytest.mark.parametrize("page", PAGES)
def test_the_frames_of_the_page_are_those_of_the_plant(page: str) -> None:
    said = (HOW_TO / page).read_text("utf-8")
    for robot in shipped().robots.values():
        x, y, yaw = (robot.drawn() or {})["at"]
        assert f"| `{root_link(robot)}` | {x:g}, {y:g} | {math.degrees(yaw):g} |" in said


@pytest.mark.parametrize("page", PAGES)
def test_the_depth_of_the_stations_is_that_of_the_plant(page: str) -> None:
    said = (HOW_TO / page).read_text("utf-8")
    for cell in (shipped().cell("sis_a"), shipped().cell("sis_b")):
        arm = cell.reach[cell.taker.robot.name]
        (depth,) = {arm.targets[each].q[2] for each in cell.station_targets}
        assert f"{depth * 1000:g} mm" in said
