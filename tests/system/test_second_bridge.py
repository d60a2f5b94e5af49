"""A second plant at the broker of the first, with a bridge of its own: it yields, and the first goes on."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.system, pytest.mark.requires("mosquitto")]


def test_a_second_bridge_yields_and_leaves_the_first_one_at_work(
    arboleda: Callable[..., Any],
    typed: Callable[..., tuple[int, str]],
    mosquitto: Callable[[int], Any],
    free_port: int,
    tmp_path: Path,
) -> None:
    mosquitto(free_port)
    at_broker = ("--no-ros", "--broker", f"127.0.0.1:{free_port}")
    first = arboleda("up", *at_broker, "--rate", "4")
    first.wait_for("HTTP API:")
    assert typed("submit", "--wait", "sis_a 0B 7")[0] == 0
    second = arboleda("up", *at_broker, "--boards", "real", "--state", str(tmp_path / "second"))
    second.wait_for("ra1: another bridge was at its board before this one")
    first.wait_for("ra1: another bridge has come to its board")
    second.interrupt()
    status, said = typed("submit", "--wait", "sis_a 0B 8")
    assert (status, "done" in said) == (0, True), said
