"""The real chain: processes whose output can be waited for, a real mosquitto, a ROS 2 node to look in."""

from __future__ import annotations

import fcntl
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
import yaml

from arboleda.model.plant_model import Evidence

from ..chromium import browsers
from ..patience import PATIENCE_S
from ..postgres import Server
from ..shared import need_tool
from ..workers import shared_between_workers
from .two_hosts import Hosts

ROOT = Path(__file__).parents[2]
WIDE = {"COLUMNS": "200"}  # of the terminal that a command takes itself to be in


class Process:
    """A child process; its output is read as it comes."""

    def __init__(self, *command: str, env: dict[str, str] | None = None) -> None:
        self.lines: list[str] = []
        self._changed = threading.Condition()
        self._child = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, **WIDE, "PYTHONUNBUFFERED": "1", "PYTHONFAULTHANDLER": "1", **(env or {})},
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def output(self) -> str:
        return "\n".join(self.lines)

    @property
    def pid(self) -> int:
        return self._child.pid

    def wait_for(self, text: str, *, times: int = 1, patience_s: float = PATIENCE_S) -> None:
        """Wait until a line holds `text`."""

        def seen() -> bool:
            return sum(text in line for line in self.lines) >= times

        with self._changed:
            if not self._changed.wait_for(lambda: seen() or not self._running, patience_s) or not seen():
                pytest.fail(f"no {text!r} in:\n{self.output}")

    def interrupt(self) -> int:
        """Ctrl-C, which a terminal sends to all of its group: the exit status."""
        os.killpg(self._child.pid, signal.SIGINT)
        return self.wait()

    def kill(self) -> None:
        """kill -9, and whatever it left of its group."""
        if self._running:
            os.killpg(self._child.pid, signal.SIGKILL)
        self.wait()

    def wait(self) -> int:
        """The exit status; where it does not end, what each of its threads is at fails the test."""
        try:
            status = self._child.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            self._child.send_signal(signal.SIGABRT)  # a fault handler of Python writes that
            self._child.wait(PATIENCE_S)
            with suppress(ProcessLookupError):
                os.killpg(self._child.pid, signal.SIGKILL)  # what it left of its group
            self._reader.join(PATIENCE_S)
            pytest.fail(f"it does not end:\n{self.output}")
        self._reader.join(PATIENCE_S)
        return status

    @property
    def _running(self) -> bool:
        return self._child.poll() is None

    def _read(self) -> None:
        assert self._child.stdout is not None
        for line in self._child.stdout:
            with self._changed:
                self.lines.append(line.rstrip())
                self._changed.notify_all()
        self._child.stdout.close()
        with self._changed:
            self._changed.notify_all()


@pytest.fixture
def start() -> Iterator[Callable[..., Process]]:
    """`start("prog", "arg", ...)`: a process that does not outlive the test."""
    running: list[Process] = []

    def go(*command: str, **options: Any) -> Process:
        running.append(Process(*command, **options))
        return running[-1]

    yield go
    for process in reversed(running):
        process.kill()


@pytest.fixture
def arboleda(start: Callable[..., Process], tmp_path: Path) -> Callable[..., Process]:
    """`arboleda("up", "--once", "sis_a 0B 7")`: the command, with a state directory of the test's own."""

    def go(verb: str, *args: str) -> Process:
        own = verb not in ("check", "conformance", "new", "tree") and "--state" not in args
        state = ("--state", str(tmp_path / "state")) if own else ()
        main = "from arboleda.cli.main import main; main()"
        return start(sys.executable, "-c", main, verb, *args, *state, env={"PYTHONPATH": paths()})

    return go


@pytest.fixture
def typed(tmp_path: Path) -> Callable[..., tuple[int, str]]:
    """`typed("submit", "sis_a 0B 7")`: status and output of a command that asks the plant of `arboleda`.

    It is run in the process of the test: a start of its own takes ten times as long as what is asked. That it
    has one is tested in test_command.py.
    """

    def go(*words: str) -> tuple[int, str]:
        from arboleda.cli.main import main

        said, status = StringIO(), 0
        command = mock.patch.object(sys, "argv", ["arboleda", *words, "--state", str(tmp_path / "state")])
        terminal = mock.patch.dict(os.environ, WIDE)
        with command, terminal, redirect_stdout(said), redirect_stderr(said):
            try:
                main()
            except SystemExit as end:
                status = int(end.code or 0)
        return status, said.getvalue().rstrip()

    return go


@pytest.fixture
def hosts(tmp_path: Path, postgres: Server, database: str, free_port: int) -> Iterator[Hosts]:
    """Where two processes of the shipped plant may be started, with boards and a broker."""
    with postgres.connection() as db:
        db.execute("DROP SCHEMA IF EXISTS plant_arboleda CASCADE")
    made = Hosts(tmp_path, database, free_port)
    yield made
    made.end()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with browsers() as launch:
        yield launch()


@pytest.fixture
def node(start: Callable[..., Process], ros_domain: int) -> Callable[..., Process]:
    """`node("mqtt_bridge", plant=..., broker=...)`: one ROS 2 node of ours in a process of its own."""

    def go(name: str, *, namespace: str = "/", **parameters: str) -> Process:
        pairs = [word for key, value in parameters.items() for word in ("-p", f"{key}:={value}")]
        ros = ("--ros-args", "-r", f"__ns:={namespace}", *pairs)
        command = (sys.executable, "-m", "arboleda_ros.nodes", name, *ros)
        return start(*command, env={"PYTHONPATH": paths()})

    return go


def paths() -> str:
    """Where this checkout's packages are found, for processes that tests start."""
    return os.pathsep.join(path for path in sys.path if path)


@pytest.fixture
def mosquitto(
    start: Callable[..., Process], require: Callable[[str], str], tmp_path: Path
) -> Callable[[int], Process]:
    """`mosquitto(port)`: a real broker on 127.0.0.1 that listens."""

    def go(port: int) -> Process:
        settings = tmp_path / "mosquitto.conf"
        settings.write_text(f"listener {port} 127.0.0.1\nallow_anonymous true\nset_tcp_nodelay true\n")
        broker = start(require("mosquitto"), "-v", "-c", str(settings))
        broker.wait_for("running")
        return broker

    return go


@pytest.fixture(scope="session")
def compiled_board(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The firmware's board of an arm as a program."""
    return _compiled(tmp_path_factory, "board")


@pytest.fixture(scope="session")
def device_board(tmp_path_factory: pytest.TempPathFactory) -> str:
    """The firmware's board of the press of examples/press_board as a program."""
    return str(Path(_compiled(tmp_path_factory, "device")).with_name("device_board"))


def _compiled(tmp_path_factory: pytest.TempPathFactory, target: str) -> str:
    """What a target of the firmware makes, built once for all workers and outside the checkout.

    A test that built it where users do would hide another that needs it without saying so.
    """
    need_tool("make")
    need_tool("g++")
    header = ["g++", "-fsyntax-only", "-include", "mosquitto.h", "-x", "c++", os.devnull]
    if subprocess.run(header, capture_output=True, check=False).returncode != 0:
        pytest.skip("libmosquitto-dev is not installed")
    folder = shared_between_workers(tmp_path_factory) / "firmware"
    with folder.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        subprocess.run(["make", "-C", str(ROOT / "firmware"), target, f"B={folder}"], check=True)
    return str(folder / target)


@pytest.fixture
def board(compiled_board: str, monkeypatch: pytest.MonkeyPatch) -> str:
    """The same program, which `--boards linux` takes in this test."""
    monkeypatch.setenv("ARBOLEDA_BOARD", compiled_board)
    return compiled_board


class Observer:
    """A ROS 2 node of another process's kind: it publishes, and keeps what it hears by topic."""

    def __init__(self) -> None:
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        self._context = Context()
        self._context.init()
        self.node = Node("observer", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.heard: dict[str, list[Any]] = {}

    def listen(self, kind: type, *topics: str, qos: Any = 10) -> None:
        for topic in topics:
            self.heard[topic] = []
            self.node.create_subscription(kind, topic, self.heard[topic].append, qos)

    def publisher(self, kind: type, topic: str) -> Any:
        """A publisher that somebody listens to."""
        made = self.node.create_publisher(kind, topic, 10)
        self.wait(lambda: made.get_subscription_count() > 0, f"nobody listens to {topic}")
        return made

    def wait(self, arrived: Callable[[], Any], otherwise: str, patience_s: float = PATIENCE_S) -> Any:
        """Spin until `arrived()` is true."""
        until = time.monotonic() + patience_s
        while not arrived():
            if time.monotonic() > until:
                last = {topic: messages[-3:] for topic, messages in self.heard.items()}
                pytest.fail(f"{otherwise}; heard last: {last}")
            self._executor.spin_once(timeout_sec=0.05)
        return arrived()

    def close(self) -> None:
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()


@pytest.fixture
def observer(ros_domain: int, require: Callable[[str], str]) -> Iterator[Observer]:
    require("rclpy")
    made = Observer()
    yield made
    made.close()


RATE = "4"
SLOW_DEG_S = 4.5  # of ra1's first joint: its moves last seconds at that rate, so they can be interrupted
SHIPPED = ROOT / "src/arboleda/arboleda/plants/plant.yaml"


@pytest.fixture
def chain(
    node: Callable[..., Any],
    mosquitto: Callable[[int], Any],
    free_port: int,
    tmp_path: Path,
    quick_discovery: None,
    observer: Any,
) -> Callable[..., Chain]:
    """`chain(evidence, stop_timeout_s=1)`: three nodes and a broker, with timing of the test's own."""

    def go(evidence: Evidence, **timing: float) -> Chain:
        broker = mosquitto(free_port)
        address = f"127.0.0.1:{free_port}"
        return Chain(node, observer, plant_at(evidence, tmp_path, **timing), address, tmp_path, broker)

    return go


def plant_at(evidence: Evidence, folder: Path, *cells: str, **timing: float) -> Path:
    """The shipped plant, or some of its cells, every robot at this level of evidence; ra1 is slow."""
    plant = yaml.safe_load(SHIPPED.read_text()) | {"timing": timing}
    plant["cells"]["sis_a"]["arm"]["speeds"] = {"q1_deg_s": SLOW_DEG_S}
    plant["cells"] = {name: cell for name, cell in plant["cells"].items() if not cells or name in cells}
    for cell in plant["cells"].values():
        cell["arm"]["evidence"] = cell["mobile"]["evidence"] = evidence.value
    file = folder / f"{'-'.join(['plant', *cells])}.yaml"
    file.write_text(yaml.safe_dump(plant))
    return file


class Chain:
    """The three nodes, and what an observer hears of them."""

    def __init__(
        self,
        node: Callable[..., Any],
        observer: Any,
        plant: Path,
        address: str,
        folder: Path,
        broker: Process,
    ) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from sensor_msgs.msg import JointState
        from std_msgs.msg import String

        self.observer = observer
        self._node = node
        self.address = address
        self.broker = broker
        self.state = str(folder / "state")
        self._common = {"plant": str(plant), "broker": address, "rate": RATE}
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        observer.listen(String, "/task_status", "/plant/view", qos=latched)
        observer.listen(JointState, "/r1/joint_states")
        self.devices = self.start("virtual_devices")
        self.bridge = self.start("mqtt_bridge")
        self.plant = self.start("orchestrator", state_dir=self.state)
        self.requests = observer.publisher(String, "/task_request")

    def start(self, name: str, **parameters: str) -> Any:
        return self._node(name, **{**self._common, **parameters})

    def submit(self, text: str) -> None:
        from std_msgs.msg import String

        self.requests.publish(String(data=text))

    def wait_for_step(self, cell: str, step: str) -> None:
        def at_step() -> bool:
            views = self.observer.heard["/plant/view"]
            cells = json.loads(views[-1].data)["cells"] if views else []
            return any(each["name"] == cell and each["step"] == step for each in cells)

        self.observer.wait(at_step, f"{cell} never got to {step!r}")

    def robot(self, name: str) -> dict[str, Any]:
        """What the last view says of a robot."""
        view = json.loads(self.observer.heard["/plant/view"][-1].data)
        return next(robot for robot in view["robots"] if robot["name"] == name)

    def cell(self, name: str) -> dict[str, Any]:
        """What the last view says of a cell."""
        view = json.loads(self.observer.heard["/plant/view"][-1].data)
        return next(cell for cell in view["cells"] if cell["name"] == name)

    def wait_for_cell(self, name: str, ready: Callable[[dict[str, Any]], bool]) -> None:
        views = self.observer.heard["/plant/view"]
        self.observer.wait(lambda: views and ready(self.cell(name)), f"{name} is not as expected")

    def wait_until_ready(self, *names: str) -> None:
        """Wait until nothing keeps these robots from a task."""
        for name in names:
            self.wait_for_robot(name, lambda robot: not robot["obstacle"])

    def wait_for_robot(self, name: str, ready: Callable[[dict[str, Any]], bool]) -> None:
        views = self.observer.heard["/plant/view"]
        self.observer.wait(lambda: views and ready(self.robot(name)), f"{name} is not as expected")

    def outcome(self, text: str) -> dict[str, Any]:
        """The change that ended the task."""

        def ended() -> list[dict[str, Any]]:
            changes = [json.loads(message.data) for message in self.observer.heard["/task_status"]]
            return [each for each in changes if each["text"] == text and each["state"] in ("done", "failed")]

        return self.observer.wait(ended, f"{text} has no end")[0]
