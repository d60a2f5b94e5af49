"""A running plant and a client of it, each test in a ROS domain of its own."""

from __future__ import annotations

import importlib.util
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arboleda.testing.domains import Domain

TYPED = ["test_execute_task.py", "test_execute_task_ends.py", "test_named_values.py", "test_typed.py"]
collect_ignore = [] if importlib.util.find_spec("arboleda_interfaces") else TYPED
if not importlib.util.find_spec("py_trees_ros_interfaces"):  # neither we nor the wheels have it
    collect_ignore = [*collect_ignore, "test_snapshot_streams.py"]

RATE = 10.0
PATIENCE_S = 60.0


@pytest.fixture(scope="module")
def ros_domain() -> Iterator[int]:
    """A ROS domain id that no other test on this machine has now."""
    domain = Domain()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain.id))
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        yield domain.id
    domain.close()


class Client:
    """Somebody else's node: sends goals, calls services, listens; it spins only while it waits."""

    def __init__(self, name: str = "client") -> None:
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node

        self._context = Context()
        self._context.init()
        self.node = Node(name, context=self._context, enable_rosout=False)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)

    def until(self, holds: Callable[[], Any], otherwise: str) -> Any:
        """Spin until `holds()`; its value."""
        end = time.monotonic() + PATIENCE_S
        while not (value := holds()):
            assert time.monotonic() < end, otherwise
            self._executor.spin_once(timeout_sec=0.02)
        return value

    def answer(self, future: Any) -> Any:
        """The result of what was asked for."""
        self.until(future.done, "no answer came")
        return future.result()

    def call(self, kind: type, service: str, **fields: Any) -> Any:
        client = self.node.create_client(kind, service)
        self.until(client.service_is_ready, f"there is no service {service}")
        return self.answer(client.call_async(kind.Request(**fields)))

    def hear(self, kind: type, topic: str, *, latched: bool = True) -> list[Any]:
        """The list that messages of a topic are appended to; if `latched`, it begins with earlier ones."""
        from rclpy.qos import DurabilityPolicy, QoSProfile

        messages: list[Any] = []
        durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
        qos = QoSProfile(depth=10, durability=durability)
        made = self.node.create_subscription(kind, topic, messages.append, qos)
        self.until(lambda: self.node.count_publishers(made.topic_name), f"nobody publishes {topic}")
        return messages

    def vanish(self) -> None:
        """Leave without a word to anybody."""
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.try_shutdown()


class Goal:
    """One goal of a client, from the request on."""

    def __init__(self, client: Client, server: Any, **fields: Any) -> None:
        from arboleda_interfaces.action import ExecuteTask

        self.client = client
        self.feedback: list[tuple[str, float]] = []
        self._sent = server.send_goal_async(ExecuteTask.Goal(**fields), feedback_callback=self._fed)
        self.handle = client.answer(self._sent)
        assert self.handle.accepted
        self._result = self.handle.get_result_async()

    def at(self, step: str) -> None:
        """Wait for a step."""
        self.client.until(lambda: step in [step_name for step_name, _ in self.feedback], f"{step} never came")

    def executing(self) -> None:
        """Wait for its task to begin."""
        self.client.until(lambda: self.feedback, "the task does not begin")

    def cancel(self) -> bool:
        """Ask for its end; whether that was accepted."""
        return bool(self.client.answer(self.handle.cancel_goal_async()).goals_canceling)

    def end(self) -> tuple[int, Any]:
        """The status in which it ended, and its result."""
        ended = self.client.answer(self._result)
        return ended.status, ended.result

    def _fed(self, message: Any) -> None:
        self.feedback.append((message.feedback.step, round(message.feedback.progress, 3)))


@pytest.fixture(scope="module", params=["EventsExecutor", "SingleThreadedExecutor"])
def link(request: pytest.FixtureRequest, ros_domain: int) -> Iterator[Callable[[], Any]]:
    """Joins ROS 2, with the executor of this parameter."""
    from arboleda_ros.link import connect

    def join() -> Any:
        made = connect()
        assert type(made._executor).__name__ == request.param
        return made

    with pytest.MonkeyPatch.context() as patch:
        if request.param == "SingleThreadedExecutor":
            patch.setitem(sys.modules, "rclpy.experimental", None)  # as on Humble
        yield join


@pytest.fixture(scope="module")
def start(link: Callable[[], Any], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[], Any]]:
    """Starts a whole plant with virtual robots, in this process."""
    from arboleda.plant_file.loader import load
    from arboleda.runtime.build import Options, build

    running: list[Any] = []

    def go() -> Any:
        state = tmp_path_factory.mktemp("state")
        options = Options(link=link(), rate=RATE, state_dir=state)
        running.append(build(load(None), {"broker", "devices", "bridge", "orchestrator"}, options))
        running[-1].start()
        return running[-1]

    yield go
    for app in running:
        app.stop()


@pytest.fixture(scope="module")
def client(ros_domain: int) -> Iterator[Client]:
    made = Client()
    yield made
    made.vanish()


@pytest.fixture(scope="module")
def execute(client: Client) -> Callable[..., Goal]:
    """`execute(text="sis_a 0B 7")`: a goal that was accepted."""
    from arboleda_interfaces.action import ExecuteTask
    from rclpy.action import ActionClient

    server = ActionClient(client.node, ExecuteTask, "plant/execute_task")

    def go(**fields: Any) -> Goal:
        client.until(server.server_is_ready, "there is no action server")
        return Goal(client, server, **fields)

    return go
