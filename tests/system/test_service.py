"""A plant that systemd has started: what systemd would hear of it, from its start to its end."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ..patience import PATIENCE_S
from .conftest import paths

pytestmark = pytest.mark.system
RUN = "from arboleda.cli.main import main; main()"


def test_a_plant_says_that_it_is_ready_that_it_lives_and_that_it_ends(
    start: Callable[..., Any], tmp_path: Path
) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as heard:
        heard.bind(str(tmp_path / "notify"))
        heard.settimeout(PATIENCE_S)
        asks = {"NOTIFY_SOCKET": heard.getsockname(), "WATCHDOG_USEC": "900000", "PYTHONPATH": paths()}
        up = start(sys.executable, "-c", RUN, "up", "--no-ros", "--state", str(tmp_path / "state"), env=asks)
        assert [heard.recv(100) for _ in range(3)] == [b"READY=1", b"WATCHDOG=1", b"WATCHDOG=1"]
        assert up.interrupt() == 0, up.output
        last = heard.recv(100)
        while last == b"WATCHDOG=1":
            last = heard.recv(100)
        assert last == b"STOPPING=1"
