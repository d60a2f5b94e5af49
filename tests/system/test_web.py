"""A plant that is open to a network, and one that is flooded."""

from __future__ import annotations

import json
import re
import resource
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import httpx
import pytest

from arboleda.adapters.web import connections, server

from .conftest import PATIENCE_S

pytestmark = pytest.mark.system


@pytest.fixture
def many_files() -> Iterator[None]:
    """As many open files as the system lets this process have."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    yield
    resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def ask(port: int, token: str = "") -> httpx.Client:
    headers = {"authorization": f"Bearer {token}"} if token else {}
    return httpx.Client(
        base_url=f"http://127.0.0.1:{port}", headers=headers, trust_env=False, timeout=PATIENCE_S
    )


def test_a_plant_on_a_network_wants_a_token_of_everybody_and_the_commands_have_it(
    arboleda: Callable[..., Any], free_port: int, tmp_path: Path
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10", "--host", "0.0.0.0", "--port", str(free_port))
    up.wait_for("the token travels in clear")
    assert str(tmp_path / "state" / "tokens.json") in up.output
    viewer, operator = (arboleda("token", role) for role in ("viewer", "operator"))
    assert viewer.wait() == operator.wait() == 0
    with ask(free_port) as nobody, ask(free_port, viewer.output) as looks:
        assert nobody.get("/api/plant").status_code == nobody.post("/api/plant/stop").status_code == 401
        assert looks.get("/api/plant").status_code == 200
        assert looks.post("/api/plant/reset").status_code == 403
    assert viewer.output not in up.output and operator.output not in up.output
    assert arboleda("submit", "sis_a 0B 7").wait() == 0
    up.wait_for("done      sis_a 0B 7")
    assert arboleda("token", "operator", "--new").wait() == 0
    with ask(free_port, operator.output) as late:
        assert late.post("/api/plant/reset").status_code == 401
    assert arboleda("stop").wait() == 0
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


def test_a_port_that_is_taken_is_refused_where_it_was_named(
    arboleda: Callable[..., Any], tmp_path: Path
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        up = arboleda("up", "--no-ros", "--port", str(port))
        assert up.wait() == 1
        assert f"cannot listen on 127.0.0.1:{port}" in up.output and "Traceback" not in up.output


def test_a_thousand_idle_sockets_and_readers_that_never_read_keep_nobody_from_the_plant(
    arboleda: Callable[..., Any], many_files: None, tmp_path: Path
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10")
    up.wait_for("HTTP API")
    found = re.search(r"HTTP API: http://127.0.0.1:(\d+)/", up.output)
    assert found
    port, pid = int(found[1]), json.loads((tmp_path / "state" / "plant.json").read_text())["pid"]
    stream = f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode()
    before = open_files(pid)
    with ExitStack() as opened:
        for number in range(1000):
            talk = opened.enter_context(socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S))
            talk.sendall(stream if number % 20 == 0 else b"GET /api/plant HTTP/1.1\r\nX-A: ")
        assert arboleda("submit", "sis_a 0B 7").wait() == 0
        up.wait_for("done      sis_a 0B 7")
        assert open_files(pid) - before <= connections.PER_PEER + server.BACKLOG
        assert arboleda("stop").wait() == 0
        assert arboleda("status").wait() == 0
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


def open_files(pid: int) -> int:
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))
