"""The real chain with nothing wrong in it: no task fails, also where an arm is told to go where it stands."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from .conftest import SHIPPED, Process, paths

pytestmark = pytest.mark.system

TASKS = 4
CELLS = ("sis_a", "sis_b")  # one arm says moving of a move of no length, the other does not
GLUED = Path(__file__).with_name("foreign_arms.py")
Start = Callable[..., Process]


def equal_neighbours(folder: Path, **arm: Any) -> str:
    """Two cells whose place is their home pose: every task begins with a move of no length."""
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["stations"]["mm"] = 0
    plant["palletizing"]["place"] = "station 0"
    plant["cells"] = {name: plant["cells"][name] for name in CELLS}
    for cell in plant["cells"].values():
        cell["arm"] |= arm
        cell["mobile"]["link"] = "none"
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    return str(file)


def must_be_done(arboleda: Start, plant: str, *options: str) -> None:
    tasks = [f"{cell} palletizing #{cell}{number}" for number in range(TASKS) for cell in CELLS]
    run = arboleda("up", "--once", *tasks, "--plant", plant, *options)
    assert run.wait() == 0, run.output


@pytest.mark.requires("mosquitto")
def test_foreign_boards_over_mqtt(
    arboleda: Start, start: Start, mosquitto: Callable[[int], Any], tmp_path: Path, free_port: int
) -> None:
    mosquitto(free_port)
    plant = equal_neighbours(tmp_path, evidence="joints", assume_homed=True)
    glued = start(sys.executable, str(GLUED), "mqtt", plant, str(free_port), env={"PYTHONPATH": paths()})
    glued.wait_for("foreign arms play")
    must_be_done(arboleda, plant, "--no-ros", "--boards", "real", "--broker", f"127.0.0.1:{free_port}")


@pytest.mark.requires("rclpy")
def test_foreign_arms_on_ros_2(
    arboleda: Start, start: Start, ros_domain: int, quick_discovery: None, tmp_path: Path, free_port: int
) -> None:
    plant = equal_neighbours(tmp_path, evidence="joints", link="ros")
    glued = start(sys.executable, str(GLUED), "ros", plant, env={"PYTHONPATH": paths()})
    glued.wait_for("foreign arms play")
    must_be_done(arboleda, plant, "--port", str(free_port))
