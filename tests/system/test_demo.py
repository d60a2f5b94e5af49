"""`arboleda up --demo`, as `make run` starts it: it goes on until somebody ends it; all robots stand then."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.client import PlantClient

from ..chromium import browsers
from ..patience import PATIENCE_S
from .conftest import Process, paths
from .page import running, until

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


def test_a_first_visit_says_what_to_click_and_a_button_ends_the_demonstration(
    page: Any, tmp_path: Path
) -> None:
    plant = PlantClient(tmp_path)
    assert len(page.locator("#demo-lines li").all_inner_texts()) == 3
    page.click("#demo-seen")
    page.reload()
    page.wait_for_selector("#demo-end")
    assert not page.is_visible("#demo-lines")
    until(lambda: ended(plant) > 3)  # more than one each, and nobody has asked for any
    page.click("#demo-end")
    page.wait_for_selector("#demo", state="hidden")
    until(lambda: all(cell["task"] is None for cell in plant.status()["cells"]))
    known = {task["id"] for task in plant.status()["tasks"]}
    page.wait_for_timeout(5000)  # longer than a cell rests between two tasks
    assert {task["id"] for task in plant.status()["tasks"]} == known
    page.reload()
    page.wait_for_selector("#connection", state="hidden")
    assert not page.is_visible("#demo")


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


def test_real_boards_are_refused(tmp_path: Path) -> None:
    command = [sys.executable, "-c", "from arboleda.cli.main import main; main()", "up", "--demo"]
    ran = subprocess.run(
        [*command, "--boards", "real", "--no-ros", "--state", str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
        env={"PYTHONPATH": paths(), "PATH": "/usr/bin:/bin"},
    )
    assert ran.returncode == 2
    assert "--demo has boards fail, so it is for virtual ones alone" in " ".join(ran.stderr.split())
