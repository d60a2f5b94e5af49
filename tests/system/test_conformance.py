"""`arboleda conformance` on a real broker: the virtual board and the firmware's pass at the top."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.app.build import Options, build
from arboleda.testing import shipped

pytestmark = [pytest.mark.system, pytest.mark.timeout(150)]

CHECKS = 24


def judged(arboleda: Callable[..., Any], port: int) -> str:
    """What the kit prints about ra_1, once it has passed."""
    kit = arboleda("conformance", "--robot", "ra_1", "--broker", f"127.0.0.1:{port}", "--yes")
    kit.wait_for("ra_1 reaches", patience_s=120)
    assert kit.wait() == 0, kit.output
    return kit.output


def test_the_firmwares_board_passes_at_the_top(
    start: Callable[..., Any],
    arboleda: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    board: str,
    free_port: int,
) -> None:
    mosquitto(free_port)
    start(board, "--robot", "ra_1", "--broker", f"127.0.0.1:{free_port}")
    said = judged(arboleda, free_port)
    assert said.count("good ") == CHECKS
    assert "ra_1 reaches the level ids" in said


def test_the_virtual_board_passes_at_the_top(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int, tmp_path: Path
) -> None:
    mosquitto(free_port)
    options = Options(broker=f"127.0.0.1:{free_port}", state_dir=tmp_path / "boards")
    boards = build(shipped("sis_a"), {"devices"}, options)
    boards.start()
    try:
        said = judged(arboleda, free_port)
    finally:
        boards.stop()
    assert said.count("good ") == CHECKS
    assert "ra_1 reaches the level ids" in said


def test_nobody_at_the_other_end_is_said(
    arboleda: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int
) -> None:
    mosquitto(free_port)
    kit = arboleda("conformance", "--robot", "ra_1", "--broker", f"127.0.0.1:{free_port}", "--yes")
    assert kit.wait() == 1
    assert "ra_1 reaches no level; wrong: telemetry" in kit.output


def test_a_robot_that_is_no_arm_is_bad_input(arboleda: Callable[..., Any]) -> None:
    kit = arboleda("conformance", "--robot", "rm_sis_a", "--yes")
    assert kit.wait() == 2
    assert "there are ra1, ra2, ra3, ra_1, ra_2, ra_3" in " ".join(kit.output.split())
