"""The socket on which systemd listens to what it started."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.patience import PATIENCE_S


@pytest.fixture
def heard(tmp_path: Path) -> Iterator[socket.socket]:
    """The socket on which systemd listens."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listens:
        listens.bind(str(tmp_path / "notify"))
        listens.settimeout(PATIENCE_S)
        yield listens


def asked(heard: socket.socket, **more: str) -> dict[str, str]:
    """The environment of a process that systemd started."""
    return {"NOTIFY_SOCKET": heard.getsockname(), **more}
