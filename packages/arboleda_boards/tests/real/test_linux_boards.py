"""The firmware's boards as programs, in the plant in place of the virtual ones."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

pytestmark = pytest.mark.system


def test_tasks_are_done_with_the_firmwares_boards_which_end_with_a_plant_that_is_killed(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int, board: str
) -> None:
    broker = mosquitto(free_port)
    where = ("--no-ros", "--boards", "linux", "--broker", f"127.0.0.1:{free_port}")
    plant = arboleda("up", "sis_a 0B 7", "sis_b 1C 3", *where)
    plant.wait_for("done      sis_a 0B 7")
    plant.wait_for("done      sis_b 1C 3")
    plant.kill()
    broker.wait_for("Received DISCONNECT from ra_1")
