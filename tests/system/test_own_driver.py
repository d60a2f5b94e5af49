"""The example with a driver of its own, as it is typed: against its virtual controller."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[2] / "examples/own_driver"


@pytest.fixture
def plant(tmp_path: Path, free_port: int) -> tuple[str, int]:
    """The plant file with a port of the test's own."""
    for name in ("recipes.py", "drivers/line_tcp.py", "plant.yaml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        text = (EXAMPLE / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace("port: 4711", f"port: {free_port}"), "utf-8")
    return str(tmp_path / "plant.yaml"), free_port


def test_the_press_works_behind_its_driver_and_a_controller_that_ends_fails_the_task(
    start: Callable[..., Any], arboleda: Callable[..., Any], plant: tuple[str, int]
) -> None:
    file, port = plant
    controller = start(sys.executable, str(EXAMPLE / "controller.py"), "--port", str(port))
    controller.wait_for("the press listens on port")
    tasks = ("shop form 2", "shop form 3")
    up = arboleda("up", *tasks, "--plant", file, "--boards", "real", "--no-ros")
    up.wait_for("done      shop 2")
    up.wait_for("press press 3")
    controller.kill()
    up.wait_for("the link was lost while doing")
    assert up.interrupt() == 0, up.output
    assert "simulated" not in up.output and "Traceback" not in up.output
