"""`arboleda conformance` on a real broker: the virtual board and the firmware's pass at the top."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.app.build import Options, build
from arboleda.testing import shipped

from .conftest import built_board

pytestmark = [pytest.mark.system, pytest.mark.timeout(150)]

CHECKS = 24


@pytest.fixture
def virtual(mosquitto: Callable[[int], Any], free_port: int, tmp_path: Path) -> Iterator[None]:
    """The virtual board of ra_2, on a broker."""
    mosquitto(free_port)
    options = Options(broker=f"127.0.0.1:{free_port}", state_dir=tmp_path / "boards")
    boards = build(shipped("sis_b"), {"devices"}, options)
    boards.start()
    yield
    boards.stop()


def test_the_virtual_board_and_the_firmwares_pass_at_the_top(
    start: Callable[..., Any], arboleda: Callable[..., Any], virtual: None, free_port: int
) -> None:
    broker = ("--broker", f"127.0.0.1:{free_port}")
    robots = ["ra_2"]
    if program := built_board():
        start(program, "--robot", "ra_1", *broker)
        robots.append("ra_1")
    kits = {robot: arboleda("conformance", "--robot", robot, *broker, "--yes") for robot in robots}
    for robot, kit in kits.items():
        kit.wait_for(f"{robot} reaches the level ids", patience_s=120)
        assert kit.wait() == 0, kit.output
        assert kit.output.count("good ") == CHECKS, kit.output
    if program is None:
        pytest.skip("firmware/build/board is not built; the virtual board passes")


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
