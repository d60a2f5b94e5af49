"""`arboleda up --demo`, as `make run` starts it: it goes on until somebody ends it; all robots stand then."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.chromium import browsers
from tests.system.conftest import Process, paths
from tests.system.page import operate, running, until

from arboleda.cli.client import PlantClient

pytestmark = [pytest.mark.system, pytest.mark.requires("chromium", "playwright")]


@pytest.fixture
def page(tmp_path: Path) -> Iterator[Any]:
    with running(tmp_path, "--demo") as address, browsers() as launch:
        opened = launch().new_context().new_page()
        opened.goto(address)
        opened.wait_for_selector("#connection", state="hidden")
        yield opened


def ended(plant: PlantClient) -> int:
    return sum(task["state"] == "done" for task in plant.status()["tasks"])


def test_a_first_visit_says_once_what_to_press_and_a_button_ends_the_demonstration(
    page: Any, tmp_path: Path
) -> None:
    plant = PlantClient(tmp_path)
    page.wait_for_selector("#demo")
    lines = page.locator("#demo li").all_inner_texts()
    assert len(lines) == 3
    assert all(f"“{button}”" in lines[1] for button in ("Make ready again", "Operate", "Provoke a fault"))
    page.click("[data-choose=sis_b]")  # whoever is at work has read it
    page.wait_for_selector("#demo", state="hidden")
    page.reload()
    page.wait_for_selector("#connection", state="hidden")
    assert not page.is_visible("#demo")
    until(lambda: ended(plant) > 3)  # more than one each, and nobody has asked for any
    operate(page)
    page.click("#demo-end")
    page.wait_for_selector("#demo-on", state="hidden")
    until(lambda: all(cell["task"] is None for cell in plant.status()["cells"]))
    page.reload()
    page.wait_for_selector("#connection", state="hidden")
    operate(page)
    assert not page.is_visible("#demo-on")


def test_ctrl_c_leaves_every_robot_still(tmp_path: Path) -> None:
    main = "from arboleda.cli.main import main; main()"
    command = ("up", "--no-ros", "--demo", "--rate", "2", "--state", str(tmp_path))
    plant = Process(sys.executable, "-c", main, *command, env={"PYTHONPATH": paths()})
    try:
        plant.wait_for("HTTP API")
        running_tasks = PlantClient(tmp_path)
        until(lambda: all(cell["task"] for cell in running_tasks.status()["cells"]))
        assert plant.interrupt() == 0, plant.output
    finally:
        plant.kill()
    left = plant.output.partition("stopping: whatever moves is halted")[2]
    assert left.count(": still") == 6, left
    assert "NOT confirmed still" not in left, left
    assert "Traceback" not in plant.output
