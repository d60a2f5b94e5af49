"""The parts a plant is put together from; each starts, stops, and owns its loop and clients."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from itertools import count
from typing import Any, Protocol
from uuid import uuid4

from arboleda.adapters.mqtt import Address, Credentials, MqttClient
from arboleda.core import view
from arboleda.core.errors import ArboledaError
from arboleda.core.messages import (
    Command,
    Heartbeat,
    Notice,
    Report,
    Shutdown,
    SystemStart,
    TaskChanged,
    TaskRequest,
    Undelivered,
)
from arboleda.core.model import PlantModel
from arboleda.core.plant import Plant
from arboleda.sim.devices import Devices, FromBoard, ToBoard
from arboleda.wire.bridge import Bridge, FromPlant
from arboleda.wire.payloads import Presence, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery, Publication

from .loop import Loop

SCOUT_S = 0.6  # boards that live send telemetry every 0.1 s
VIEW_S = 1.0

Crash = Callable[[str, Exception], None]


class Part(Protocol):
    """One piece of a plant; `stop` is idempotent and waits for its end."""

    def start(self) -> None: ...
    def stop(self) -> None: ...


class Broker(Protocol):
    """Where the MQTT clients of this process go; read once it is started."""

    address: Address
    credentials: Credentials | None


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
        """Ask for a task; the future holds the change that answers: queued, refused, or the known task's state."""
        token, answer = uuid4().hex, Future[TaskChanged]()
        self._waiting[token] = answer
        self.loop.post(TaskRequest(at=time.monotonic(), text=text, request=token))
        return answer

    def snapshot(self) -> dict[str, Any]:
        return self.loop.read(view.snapshot)

    def stop(self) -> None:
        """Halt whatever moves and wait until the robots confirm it, or the stop time-out has passed."""
        self.loop.post(Shutdown(at=time.monotonic()))
        self._at_rest.wait(self.plant.model.timing.stop_timeout_s + 1.0)
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


class BridgePart:
    """The bridge in its loop, with its MQTT client; `connect` its plant side before `start`."""

    def __init__(self, model: PlantModel, epoch: int, broker: Broker, crash: Crash) -> None:
        self._broker = broker
        self._bridge = Bridge(model, epoch=epoch, now=time.monotonic())
        self._version = model.mqtt_version
        self._client: MqttClient | None = None
        self._report: Callable[[Report], None] = lambda report: None
        self.loop: Loop[Any, Any] = Loop("bridge", self._bridge, self._send, on_crash=crash)

    def connect(self, report: Callable[[Report], None]) -> None:
        self._report = report

    def send(self, message: Command | Notice) -> None:
        """The plant's port where plant and bridge share a process."""
        if not isinstance(message, SystemStart | TaskChanged):
            self.loop.post(FromPlant(at=time.monotonic(), message=message))

    def start(self) -> None:
        self.loop.start()
        self._client = MqttClient(
            f"arboleda_bridge_{uuid4().hex[:8]}",
            self._broker.address,
            subscriptions=self._bridge.subscriptions,
            on_event=self.loop.post,
            credentials=self._broker.credentials,
            version=self._version,
        )
        self._client.start()

    def stop(self) -> None:
        self.loop.stop()
        if self._client is not None:
            self._client.close()

    def _send(self, message: Publication | Report) -> None:
        if isinstance(message, Report):
            self._report(message)
        elif self._client is not None:
            self._client.publish(message)


class DevicesPart:
    """The virtual boards in one loop, each with an MQTT client and a last will of its own."""

    def __init__(
        self, model: PlantModel, first_boot: int, broker: Broker, crash: Crash, *, scout: bool
    ) -> None:
        self._broker = broker
        self._crash = crash
        self._scout = scout
        self._version = model.mqtt_version
        self._devices = Devices(model, now=time.monotonic(), boot_ids=count(first_boot).__next__)
        self._clients: dict[str, MqttClient] = {}
        self._lock = threading.Lock()
        self._lookout: Lookout | None = None
        self.loop: Loop[Any, Any] = Loop("devices", self._devices, self._send, on_crash=crash)

    def start(self) -> None:
        """Join the broker; with `scout`, only after it was seen that no real board has these names."""
        self.loop.start()
        if self._scout:
            self._lookout = Lookout(self._broker, tuple(self._devices.boards), self._join, self._crash)
            self._lookout.start()
        else:
            self._join()

    def stop(self) -> None:
        if self._lookout is not None:
            self._lookout.stop()
        with self._lock:
            clients, self._clients = self._clients, {}
        for board, client in clients.items():
            self._leave(board, client)
        self.loop.stop()

    def _join(self) -> None:
        with self._lock:
            for number, board in enumerate(self._devices.boards):
                self._clients[board] = self._client(board, announce=number == 0)
            for client in self._clients.values():
                client.start()

    def _client(self, board: str, *, announce: bool) -> MqttClient:
        gone = Publication(topic=topic(board, Channel.PRESENCE), payload=encode(Presence(online=False)))
        return MqttClient(
            board,
            self._broker.address,
            subscriptions=self._devices.subscriptions(board),
            on_event=lambda event: self.loop.post(ToBoard(board=board, event=event)),
            will=replace(gone, retain=True),
            credentials=self._broker.credentials,
            version=self._version,
            announce=announce,
        )

    def _leave(self, board: str, client: MqttClient) -> None:
        gone = encode(Presence(online=False))
        try:
            client.publish(Publication(topic=topic(board, Channel.PRESENCE), payload=gone, retain=True))
        except ArboledaError:
            pass  # without a connection there is nobody to tell
        client.close()

    def _send(self, message: FromBoard) -> None:
        client = self._clients.get(message.board)
        if client is not None:
            client.publish(message.publication)


class Lookout:
    """Listens on a broker for boards that live there already; calls `clear` once if there are none."""

    def __init__(
        self, broker: Broker, boards: Sequence[str], clear: Callable[[], None], crash: Crash
    ) -> None:
        self._clear = clear
        self._crash = crash
        self._timer: threading.Timer | None = None
        self._found: set[str] = set()
        self._client = MqttClient(
            f"arboleda_lookout_{uuid4().hex[:8]}",
            broker.address,
            subscriptions=[topic(board, Channel.TELEMETRY) for board in boards],
            on_event=self._heard,
            credentials=broker.credentials,
            announce=False,
        )

    def start(self) -> None:
        self._client.start()

    def stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._client.close()

    def _heard(self, event: Delivery | Connection) -> None:
        if isinstance(event, Delivery):
            self._found.add(event.topic.split("/")[0])
        elif event.up and self._timer is None:
            self._timer = threading.Timer(SCOUT_S, self._decide)
            self._timer.daemon = True
            self._timer.start()

    def _decide(self) -> None:
        self._client.close()
        if not self._found:
            self._clear()
            return
        names = ", ".join(sorted(self._found))
        sentence = f"{names} already live on this broker, virtual boards of the same names would fight them"
        self._crash("devices", ArboledaError(f"{sentence}; use --boards real"))
