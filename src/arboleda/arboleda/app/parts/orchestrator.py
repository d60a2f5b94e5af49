"""The plant in its loop, and who listens to it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any, Protocol
from uuid import uuid4

from arboleda.core import view
from arboleda.core.messages import (
    Command,
    Heartbeat,
    Notice,
    Shutdown,
    SystemStart,
    TaskChanged,
    TaskRequest,
    Undelivered,
)
from arboleda.core.model import PlantModel
from arboleda.core.plant import Plant

from ..loop import Loop
from .part import Crash

VIEW_S = 1.0
PATIENCE_S = 6.0  # a stop is confirmed within stop_timeout_s, 5 s in the shipped plant


class PlantPort(Protocol):
    """The way from the plant to its robots."""

    def send(self, message: Command | Notice) -> None: ...


class RosPort(PlantPort, Protocol):
    """The plant's port on ROS 2, which carries snapshots too and knows whether it is alone."""

    def check_alone(self) -> None: ...
    def publish_view(self, view: dict[str, Any]) -> None: ...
    def publish_diagnostics(self, statuses: Sequence[view.Diagnostic]) -> None: ...


class Orchestrator:
    """The plant in its loop; `connect` its port before `start`."""

    def __init__(self, model: PlantModel, epoch: int, crash: Crash) -> None:
        self.plant = Plant(model, epoch=epoch, now=time.monotonic())
        self.loop: Loop[Any, Any] = Loop(
            "orchestrator",
            self.plant,
            self._send,
            on_crash=crash,
            on_send_error=self._not_sent,
            on_step=self._stepped,
        )
        self.listeners: list[Callable[[TaskChanged], None]] = []
        self.watchers: list[Callable[[dict[str, Any]], None]] = []
        self._port: PlantPort | None = None
        self._ros: RosPort | None = None
        self._shown = (-1, 0.0)
        self._waiting: dict[str, Future[TaskChanged]] = {}
        self._at_rest = threading.Event()

    def connect(self, port: PlantPort) -> None:
        self._port = port

    def connect_ros(self, port: RosPort) -> None:
        self._port = self._ros = port
        self.watchers.append(port.publish_view)
        self.watchers.append(lambda snapshot: port.publish_diagnostics(view.diagnostics(snapshot)))

    def start(self) -> None:
        """StartError where another node already commands these robots."""
        if self._ros is not None:
            self._ros.check_alone()
        self.loop.start()

    def submit(self, text: str) -> Future[TaskChanged]:
        """Ask for a task; the future holds the answer: queued, refused, or the known task's state."""
        token, answer = uuid4().hex, Future[TaskChanged]()
        self._waiting[token] = answer
        self.loop.post(TaskRequest(at=time.monotonic(), text=text, request=token))
        return answer

    def snapshot(self) -> dict[str, Any]:
        return self.loop.read(view.snapshot)

    def find(self, task: str) -> dict[str, Any] | None:
        return self.loop.read(lambda plant: view.task_by_id(plant, task))

    def stop(self) -> None:
        """Halt whatever moves and wait until the robots confirm it, at most PATIENCE_S."""
        self.loop.post(Shutdown(at=time.monotonic()))
        if self.loop.running:
            self._at_rest.wait(PATIENCE_S)
        self.loop.stop()

    def _send(self, message: Command | Notice) -> None:
        if isinstance(message, TaskChanged):
            self._answer(message)
        if self._port is not None:
            self._port.send(message)

    def _answer(self, change: TaskChanged) -> None:
        waiting = self._waiting.pop(change.request or "", None)
        if waiting is not None:
            waiting.set_result(change)
        for listener in self.listeners:
            listener(change)

    def _not_sent(self, message: Any, error: Exception) -> None:
        if isinstance(message, Heartbeat | SystemStart | TaskChanged):
            raise error
        event = Undelivered(at=time.monotonic(), id=message.id, robot=message.robot, sentence=str(error))
        self.loop.post(event)

    def _stepped(self, now: float, _events: Sequence[Any], _messages: Sequence[Any]) -> None:
        if self.plant.intake.closed and self.plant.at_rest:
            self._at_rest.set()
        version, shown_at = self._shown
        if version == self.plant.version and now - shown_at < VIEW_S:
            return
        self._shown = (self.plant.version, now)
        snapshot = view.snapshot(self.plant)
        for watcher in self.watchers:
            watcher(snapshot)
