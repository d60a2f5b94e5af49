"""A plant that is open to a network, and one that is flooded."""

from __future__ import annotations

import json
import re
import resource
import socket
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, suppress
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import httpx
import pytest

from arboleda.adapters import descriptors
from arboleda.web.server import Admission

from ..patience import PATIENCE_S
from .conftest import Process, paths

pytestmark = pytest.mark.system
Typed = Callable[..., tuple[int, str]]


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
    arboleda: Callable[..., Any], typed: Typed, free_port: int, tmp_path: Path
) -> None:
    up = arboleda("up", "--no-ros", "--rate", "10", "--host", "0.0.0.0", "--port", str(free_port))
    up.wait_for("the token travels in clear")
    assert str(tmp_path / "state" / "tokens.json") in up.output
    (of_viewer, viewer), (of_operator, operator) = (typed("token", role) for role in ("viewer", "operator"))
    assert of_viewer == of_operator == 0
    with ask(free_port) as nobody, ask(free_port, viewer) as looks:
        assert nobody.get("/api/plant").status_code == nobody.post("/api/plant/stop").status_code == 401
        assert nobody.get("/metrics").status_code == 401
        assert looks.get("/api/plant").status_code == 200
        assert looks.post("/api/plant/reset").status_code == 403
    assert viewer not in up.output and operator not in up.output
    assert typed("submit", "sis_a 0B 7")[0] == 0
    up.wait_for("done      sis_a 0B 7")
    with ask(free_port, viewer) as prometheus:
        counts = prometheus.get("/metrics").text.splitlines()
    assert 'arboleda_tasks_ended_total{cell="sis_a",outcome="done",reason=""} 1.0' in counts
    assert any(
        line.startswith("arboleda_reaction_seconds_count") and not line.endswith(" 0.0") for line in counts
    )
    assert typed("token", "operator", "--new")[0] == 0
    with ask(free_port, operator) as late:
        assert late.post("/api/plant/reset").status_code == 401
    assert typed("stop")[0] == 0
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


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
        most = Admission(descriptors.divided(descriptors.SELECT_SEES, boards=6).http).per_peer
        assert open_files(pid) - before <= most + descriptors.ON_THE_WAY
        assert arboleda("stop").wait() == 0
        assert arboleda("status").wait() == 0
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


def test_idle_clients_of_the_broker_leave_a_way_in_for_stop(
    many_files: None, start: Callable[..., Process], tmp_path: Path
) -> None:
    limit = 128
    too_few = few_files(start, limit // 2, "up", "--no-ros", "--state", str(tmp_path / "too-few"))
    assert too_few.wait() == 1
    assert "open files, and the system allows 64" in too_few.output and "Traceback" not in too_few.output
    up = few_files(start, limit, "up", "--no-ros", "--rate", "10", "--state", str(tmp_path / "state"))
    up.wait_for("HTTP API")
    web, mqtt = (
        int(re.search(rf"{what}: [a-z:/]*127.0.0.1:(\d+)", up.output)[1])  # type: ignore[index]
        for what in ("HTTP API", "MQTT broker")
    )
    with ExitStack() as opened:
        for number in range(limit + 100):
            talk = opened.enter_context(socket.create_connection(("127.0.0.1", mqtt), timeout=PATIENCE_S))
            with suppress(ConnectionError):
                talk.sendall(hello(number) if number % 2 else b"")
        answers = []
        for _ in range(20):
            with closing(HTTPConnection("127.0.0.1", web, timeout=PATIENCE_S)) as person:
                person.request("POST", "/api/plant/stop")
                answers.append(person.getresponse().status)
        assert answers == [200] * 20
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


def few_files(start: Callable[..., Process], limit: int, *args: str) -> Process:
    """The command, in a process that may have only so many files open."""
    main = "from arboleda.cli.main import main; main()"
    words = ("sh", "-c", f'ulimit -n {limit} && exec "$@"', "sh", sys.executable, "-c", main)
    return start(*words, *args, env={"PYTHONPATH": paths()})


def hello(number: int) -> bytes:
    """What a client of the broker says to come in: CONNECT of MQTT 3.1.1, no keep-alive, an id of its own."""
    id = f"idle{number:08}".encode()
    return b"\x10" + bytes([12 + len(id)]) + b"\x00\x04MQTT\x04\x02\x00\x00\x00" + bytes([len(id)]) + id


def open_files(pid: int) -> int:
    return len(list(Path(f"/proc/{pid}/fd").iterdir()))
