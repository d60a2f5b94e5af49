"""What our nodes say on `/rosout`, on their console and in their log file."""

from __future__ import annotations

import fcntl
import logging
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.runtime.log_queue import log_to
from arboleda.testing import shipped

from ..patience import PATIENCE_S
from .conftest import paths

pytestmark = [pytest.mark.system, pytest.mark.requires("rclpy")]

CONSOLE = re.compile(r"^\[(\w+)\] \[(\d{10}\.\d{9})\] \[([\w.]+)\]: (.*)$")
PIPE_BYTES = 4096
TASK = "sis_a 0B 7"


@pytest.fixture
def rosout(observer: Any) -> list[Any]:
    """What comes on `/rosout`, from the last lines before on."""
    from rcl_interfaces.msg import Log
    from rclpy.qos import DurabilityPolicy, QoSProfile

    observer.listen(Log, "/rosout", qos=QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    return observer.heard["/rosout"]


@pytest.fixture
def link(ros_domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    from arboleda_ros.link import connect

    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    made = connect()
    yield made
    made.close()


def said(rosout: list[Any]) -> list[tuple[int, str, str]]:
    """(level, logger, text) of the lines of our nodes."""
    return [(line.level, line.name, line.msg) for line in rosout if not line.name.startswith("observer")]


def test_each_line_is_said_by_its_node_with_its_level_and_nothing_by_one_that_is_gone(
    link: Any, rosout: list[Any], observer: Any, capfd: pytest.CaptureFixture[str]
) -> None:
    link.orchestrator(shipped("sis_a"), print, time.monotonic)
    port = link.bridge(shipped("sis_a"), print, time.monotonic)
    link.start()
    levels = {"debug": 10, "info": 20, "warning": 30, "error": 40, "critical": 50}
    with log_to(link.log):
        for word in levels:
            getattr(logging.getLogger("arboleda.tasks"), word)("a line at %s", word)
        logging.getLogger("asyncio").error("a library warns")
        port.topics.log_once("of the bridge", logging.WARNING)
    wanted = [
        (level, "orchestrator.tasks", f"a line at {word}") for word, level in levels.items() if level > 10
    ]
    wanted.append((40, "orchestrator.asyncio", "a library warns"))
    of_bridge = [(30, "mqtt_bridge.ros", "of the bridge")]
    observer.wait(lambda: len(said(rosout)) >= len(wanted + of_bridge), "lines are missing")
    heard = said(rosout)  # in order for each node, as each publishes for itself
    assert [line for line in heard if line in wanted] == wanted
    assert [line for line in heard if line in of_bridge] == of_bridge
    assert not [line for line in said(rosout) if line[0] == 10], "the default level is INFO"
    capfd.readouterr()
    with log_to(link.log):
        link.close()
        logging.getLogger("arboleda.tasks").warning("too late for ROS 2")
    assert capfd.readouterr().err == ""


@pytest.fixture
def nodes(node: Callable[..., Any], mosquitto: Callable[[int], Any], free_port: int, tmp_path: Path) -> Any:
    """The three nodes, in the namespace lab1; the plant's own process."""
    mosquitto(free_port)
    common = {"broker": f"127.0.0.1:{free_port}", "rate": "10.0"}
    state = str(tmp_path / "state")
    node("virtual_devices", namespace="/lab1", state_dir=state, **common)
    node("mqtt_bridge", namespace="/lab1", state_dir=state, **common)
    return node("orchestrator", namespace="/lab1", state_dir=state, **common)


@pytest.mark.requires("mosquitto")
def test_tasks_and_operators_are_lines_of_rosout_console_and_file(
    nodes: Any, rosout: list[Any], observer: Any, quick_discovery: None, tmp_path: Path
) -> None:
    from diagnostic_msgs.msg import DiagnosticArray
    from std_msgs.msg import String
    from std_srvs.srv import Trigger

    observer.listen(DiagnosticArray, "/diagnostics")
    requests = observer.publisher(String, "/lab1/task_request")
    hold = observer.node.create_client(Trigger, "/lab1/plant/hold")
    observer.wait(hold.service_is_ready, "there is no service")
    observer.wait(lambda: are_ready(observer, "ra1", "rm_sis_a"), "the robots of the cell are not ready")
    before = time.time()
    requests.publish(String(data="sis_z 0B\x1b[2J 7"))
    requests.publish(String(data=TASK))
    lines = {
        (20, "lab1.orchestrator.tasks", f"queued    {TASK}"),
        (20, "lab1.orchestrator.tasks", f"running   {TASK}"),
    }
    observer.wait(lambda: lines <= set(said(rosout)), f"not all of {lines}")
    answer = hold.call_async(Trigger.Request())
    observer.wait(answer.done, "hold is not answered")

    def operators() -> list[str]:
        return [text for _, name, text in said(rosout) if name == "lab1.orchestrator.operators"]

    observer.wait(operators, "nothing is said of the operator")
    assert answer.result().success and operators() == ["hold plant"]
    refused = [
        text for level, name, text in said(rosout) if name == "lab1.orchestrator.requests" and level == 30
    ]
    assert len(refused) == 1 and "\\x1b[2J" in refused[0] and "\x1b" not in refused[0]
    nodes.wait_for(f"running   {TASK}")
    console = [found.groups() for line in nodes.lines if (found := CONSOLE.match(line))]
    level, at, name, _ = next(line for line in console if line[3] == f"queued    {TASK}")
    assert (level, name) == ("INFO", "lab1.orchestrator.tasks")
    assert before - 1 < float(at) < time.time() + 1
    file = tmp_path / "state" / "arboleda.log"
    written = r"^\d{4}-\d\d-\d\d [\d:,]+ INFO arboleda\."
    for line in (f"tasks: queued    {TASK}$", "operators: hold plant"):
        observer.wait(lambda line=line: re.search(written + line, file.read_text(), re.MULTILINE), line)


def are_ready(observer: Any, *robots: str) -> bool:
    """Whether `/diagnostics`, which all plants share, calls robots of this one ready."""
    statuses = [status for message in observer.heard["/diagnostics"] for status in message.status]
    assert all(status.name.startswith("arboleda: lab1/") for status in statuses)
    last = {status.name: status.message for status in statuses}
    return all(last.get(f"arboleda: lab1/{robot}") == "ready" for robot in robots)


@pytest.fixture
def unread(ros_domain: int, tmp_path: Path) -> Iterator[subprocess.Popen[bytes]]:
    """An orchestrator whose console nobody reads, with room for few lines."""
    read, write = os.pipe()
    fcntl.fcntl(write, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    command = (sys.executable, "-m", "arboleda_ros.nodes", "orchestrator", "--ros-args")
    child = subprocess.Popen(
        [*command, "-p", f"state_dir:={tmp_path / 'state'}"],
        stdin=subprocess.DEVNULL,
        stdout=write,
        stderr=write,
        env={**os.environ, "PYTHONPATH": paths()},
    )
    os.close(write)
    yield child
    os.close(read)
    child.kill()
    child.wait()


def test_a_console_that_nobody_reads_does_not_stop_the_plant(
    unread: subprocess.Popen[bytes], observer: Any, rosout: list[Any], quick_discovery: None
) -> None:
    from std_msgs.msg import String, UInt32

    observer.listen(UInt32, "/plant/heartbeat")
    beats = observer.heard["/plant/heartbeat"]
    requests = observer.publisher(String, "/task_request")
    observer.wait(lambda: beats, "the plant does not beat")
    for number in range(2 * PIPE_BYTES // 100):  # a line takes more than 100 bytes
        requests.publish(String(data=f"no task {number}"))
    refused = "orchestrator.requests"
    observer.wait(lambda: sum(refused in line.name for line in rosout) > 50, "lines are missing on /rosout")
    seen = len(beats)
    observer.wait(lambda: len(beats) > seen + 3, "the plant has stopped with its console")
    unread.send_signal(signal.SIGTERM)
    assert unread.wait(PATIENCE_S) == 0
