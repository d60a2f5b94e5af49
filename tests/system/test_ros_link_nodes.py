"""The three ROS 2 nodes as processes: they start, take their parameters and end cleanly on a signal."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

from arboleda.runtime.state import find_running

pytest.importorskip("rclpy", reason="rclpy is not installed")

from arboleda_ros.link import connect

from ..patience import PATIENCE_S

pytestmark = pytest.mark.system

Start = Callable[..., subprocess.Popen[str]]


@pytest.fixture
def start(ros_domain: int, free_port: int, tmp_path: Path) -> Iterator[Start]:
    """Starts a node by name in a domain of its own, at a broker that is not there."""
    nodes: list[subprocess.Popen[str]] = []

    def run(name: str, *parameters: str) -> subprocess.Popen[str]:
        given = (f"broker:=127.0.0.1:{free_port}", f"state_dir:={tmp_path}", *parameters)
        flags = [word for parameter in given for word in ("-p", parameter)]
        command = [sys.executable, "-m", "arboleda_ros.nodes", name, "--ros-args", *flags]
        nodes.append(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True))
        return nodes[-1]

    yield run
    for node in nodes:
        node.kill()
        node.communicate()


def appeared(name: str) -> bool:
    """Whether the node joins the domain in time."""
    link = connect()
    try:
        watcher = link.node("watcher")
        link.start()
        until = time.monotonic() + PATIENCE_S
        while name not in watcher.get_node_names() and time.monotonic() < until:
            time.sleep(0.02)
        return name in watcher.get_node_names()
    finally:
        link.close()


def test_every_node_ends_cleanly_when_it_is_told_to_the_dashboard_with_the_orchestrator(
    start: Start, tmp_path: Path
) -> None:
    """A terminal's Ctrl-C, which is another signal, ends them in test_processes.py."""
    nodes = {name: start(name, "rate:=10") for name in ("mqtt_bridge", "virtual_devices")}
    nodes["orchestrator"] = start("orchestrator", "dashboard:=true")
    until = time.monotonic() + PATIENCE_S
    while (running := find_running(tmp_path)) is None or running.port is None:
        assert time.monotonic() < until, "no HTTP API was announced"
        time.sleep(0.05)
    plant = httpx.get(f"http://127.0.0.1:{running.port}/api/plant", timeout=PATIENCE_S).json()
    assert [cell["name"] for cell in plant["cells"]] == ["sis_a", "sis_b", "sis_c"]
    for name, node in nodes.items():
        assert appeared(name), (name, node.poll())
    for name, node in nodes.items():
        node.send_signal(signal.SIGTERM)
        said, _ = node.communicate(timeout=PATIENCE_S)
        assert (name, node.returncode, "Traceback" in said) == (name, 0, False), said


@pytest.mark.parametrize(
    ("parameter", "sentence"),
    [("rate:=fast", "a number is needed"), ("use_sim_time:=true", "goes by the clock of its machine")],
)
def test_a_bad_parameter_is_one_sentence(start: Start, parameter: str, sentence: str) -> None:
    node = start("mqtt_bridge", parameter)
    said, _ = node.communicate(timeout=PATIENCE_S)
    assert node.returncode == 1, said
    assert sentence in said and "Traceback" not in said
