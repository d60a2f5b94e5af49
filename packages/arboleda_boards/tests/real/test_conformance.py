"""`arboleda conformance` on a real broker: the firmware's boards pass at the top."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda_boards.conformance.judge import CHECKS, DEVICE_CHECKS

pytestmark = pytest.mark.system

PRESS = Path(__file__).parents[4] / "examples/press_board/plant.yaml"


def test_the_firmwares_board_of_an_arm_passes_at_the_top(
    arboleda: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    start: Callable[..., Any],
    board: str,
    free_port: int,
) -> None:
    mosquitto(free_port)
    start(board, "--robot", "ra_1", "--broker", f"127.0.0.1:{free_port}")
    kit = arboleda("conformance", "--robot", "ra_1", "--broker", f"127.0.0.1:{free_port}", "--yes")
    kit.wait_for("ra_1 reaches the level ids", patience_s=120)
    assert kit.wait() == 0, kit.output
    assert kit.output.count("good ") == len(CHECKS), kit.output


def test_the_firmwares_board_of_a_declared_device_passes_at_the_top(
    arboleda: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    start: Callable[..., Any],
    device_board: str,
    free_port: int,
) -> None:
    mosquitto(free_port)
    start(device_board, "--broker", f"127.0.0.1:{free_port}")
    where = ("--plant", str(PRESS), "--broker", f"127.0.0.1:{free_port}")
    kit = arboleda("conformance", "--robot", "press", *where, "--yes")
    kit.wait_for("press_1 reaches the level ids", patience_s=120)
    assert kit.wait() == 0, kit.output
    assert kit.output.count("good ") == len(DEVICE_CHECKS), kit.output
