"""The board of the examples in a process of its own, on a broker with a plant."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker import EmbeddedBroker

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[2] / "examples/own_board"


def test_a_plant_works_with_the_board_and_notices_when_it_is_gone(
    start: Callable[..., Any], arboleda: Callable[..., Any]
) -> None:
    broker = EmbeddedBroker(port=0)
    address = str(broker.start())
    try:
        board = start(sys.executable, str(EXAMPLE / "board.py"), "--broker", address)
        plant = ("--plant", str(EXAMPLE / "plant.yaml"), "--broker", address, "--boards", "real", "--no-ros")
        run = arboleda("up", "--once", "bench fill 5", *plant)
        assert run.wait() == 0, run.output
        assert "done      bench 5" in run.output
        up = arboleda("up", "bench fill 10", *plant)
        up.wait_for("valve dose 10")
        board.kill()
        up.wait_for("link_lost")
        assert up.interrupt() == 0
    finally:
        broker.stop()
