"""The node `orchestrator` on a database: it waits in `/diagnostics`, and leads once nobody else does."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed")

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from tests.patience import PATIENCE_S
from tests.postgres import Server

from arboleda.runtime.state import find_running
from arboleda_fleet.postgres.memory import PostgresMemory
from arboleda_kills.processes import paths

pytestmark = [pytest.mark.system, pytest.mark.usefixtures("quick_discovery")]
NAME = "arboleda"


@pytest.fixture
def heard(ros_domain: int) -> Iterator[Callable[[str], list[tuple[int, str]]]]:
    """Level and sentence of all that `/diagnostics` has said so far of a name."""
    context, said = Context(), []
    rclpy.init(context=context)
    node = rclpy.create_node("listener", context=context)
    node.create_subscription(DiagnosticArray, "/diagnostics", said.append, 50)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)

    def of(name: str) -> list[tuple[int, str]]:
        executor.spin_once(timeout_sec=0.05)
        rows = [row for message in said for row in message.status if row.name == name]
        return [(row.level[0], row.message) for row in rows]

    yield of
    executor.shutdown()
    node.destroy_node()
    context.try_shutdown()


def test_a_node_that_waits_says_so_in_the_diagnostics_and_leads_then(
    heard: Callable[[str], list[tuple[int, str]]],
    postgres: Server,
    database: str,
    tmp_path: Path,
    monkeypatch,
) -> None:
    with postgres.connection() as db:
        db.execute(f"DROP SCHEMA IF EXISTS plant_{NAME} CASCADE")
    leader = PostgresMemory(database, NAME)
    leader.open()
    leader.lead.take(int(time.time()))
    monkeypatch.setenv("PYTHONPATH", paths())
    values = (
        f"store:={database}",
        "standby:=true",
        "dashboard_host:=0.0.0.0",
        f"state_dir:={tmp_path}/state",
    )
    words = [word for value in values for word in ("-p", value)]
    command = [sys.executable, "-m", "arboleda_ros.nodes", "orchestrator", "--ros-args", *words]
    node = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        name = f"arboleda: standby on {socket.gethostname()}"
        waits = "waits for the end of process"
        until(lambda: leader.lead.renew() or any(waits in said for level, said in heard(name) if level == 0))
        assert not heard("arboleda: orchestrator on ROS 2")
        running = find_running(tmp_path / "state")
        assert running is not None and running.guarded, "other hosts reach it, with a token"
        assert httpx.get(f"{running.url}/api/plant", trust_env=False, timeout=PATIENCE_S).status_code == 401
        leader.close()
        until(lambda: heard("arboleda: orchestrator on ROS 2"))
        assert heard(name)[-1] == (0, "leads the plant from now on")
    finally:
        leader.close()
        node.terminate()
        said = node.communicate(timeout=PATIENCE_S)[0]
    assert node.returncode == 0 and "Traceback" not in said, said


def until(true: Callable[[], object]) -> None:
    patience = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < patience
