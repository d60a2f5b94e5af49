"""`arboleda conformance` on a real broker: the virtual board and the firmware's pass at the top."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.board_kit.conformance.judge import CHECKS, DEVICE_CHECKS
from arboleda.runtime.build import Options, build
from arboleda.testing import shipped

pytestmark = pytest.mark.system

PRESS = Path(__file__).parents[2] / "examples/press_board/plant.yaml"


@pytest.fixture
def virtual(free_port: int, tmp_path: Path) -> Iterator[str]:
    """The virtual board of ra_2, on the broker."""
    options = Options(broker=f"127.0.0.1:{free_port}", state_dir=tmp_path / "boards")
    boards = build(shipped("sis_b"), {"devices"}, options)
    boards.start()
    yield "ra_2"
    boards.stop()


@pytest.fixture
def firmware(start: Callable[..., Any], board: str, free_port: int) -> str:
    """The firmware's board of ra_1, on the broker."""
    start(board, "--robot", "ra_1", "--broker", f"127.0.0.1:{free_port}")
    return "ra_1"


@pytest.mark.parametrize("kind", ["virtual", "firmware"])
def test_a_board_of_ours_passes_at_the_top(
    kind: str,
    request: pytest.FixtureRequest,
    arboleda: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    free_port: int,
) -> None:
    mosquitto(free_port)
    robot = request.getfixturevalue(kind)
    kit = arboleda("conformance", "--robot", robot, "--broker", f"127.0.0.1:{free_port}", "--yes")
    kit.wait_for(f"{robot} reaches the level ids", patience_s=120)
    assert kit.wait() == 0, kit.output
    assert kit.output.count("good ") == len(CHECKS), kit.output


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
