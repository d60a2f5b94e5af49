"""The composition root: which parts make up this plant, and how they are joined."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Collection
from concurrent.futures import Future
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.mqtt import Address, Credentials
from arboleda.adapters.web import Api
from arboleda.core import view
from arboleda.core.errors import ArboledaError, StartError
from arboleda.core.messages import TaskChanged
from arboleda.core.model import Arm, Cell, Joint, Link, PlantModel

from .parts import BridgePart, DevicesPart, Orchestrator, Part
from .state import StateDir, default_state

PARTS = ("broker", "devices", "bridge", "orchestrator", "web")
MQTT_PORT = 1883
LOG = logging.getLogger(__name__)


@dataclass(frozen=True, kw_only=True)
class Options:
    """What the command line or the ROS parameters chose; `link` is the ROS 2 link, None without ROS."""

    link: Any | None = None
    broker: str | None = None
    broker_host: str = "127.0.0.1"
    broker_users: dict[str, str] | None = None
    credentials: Credentials | None = None
    rate: float = 1.0
    state_dir: Path | None = None


class BrokerPart:
    """The broker: the embedded one where no other was named."""

    def __init__(self, model: PlantModel, options: Options, *, embedded: bool) -> None:
        boards = frozenset(robot.mqtt for robot in model.robots.values())
        self.credentials = options.credentials
        self.address = address(options.broker or f"127.0.0.1:{MQTT_PORT}")
        self._make: Callable[[int], EmbeddedBroker] = lambda port: EmbeddedBroker(
            options.broker_host, port, users=options.broker_users, boards=boards
        )
        self._embedded = embedded
        self._open = options.broker_users is not None
        self._broker: EmbeddedBroker | None = None

    def start(self) -> None:
        """Take port 1883; where it is taken, any free one, unless boards outside must find it."""
        if not self._embedded:
            return
        try:
            self._start(MQTT_PORT)
        except StartError:
            if self._open:
                raise
            self._start(0)

    def stop(self) -> None:
        if self._broker is not None:
            self._broker.stop()

    def _start(self, port: int) -> None:
        broker = self._make(port)
        self.address = broker.start()
        self.credentials = broker.credentials
        self._broker = broker


class App:
    """A plant put together; `start`, `wait` until something ends it, `stop`."""

    def __init__(self, model: PlantModel, parts: Collection[str], options: Options) -> None:
        self.model = at_rate(model, options.rate)
        self.orchestrator: Orchestrator | None = None
        self._state = StateDir(options.state_dir or default_state(model.name))
        self._broker = BrokerPart(model, options, embedded="broker" in parts)
        self._web = WebPart(self, self._state) if "web" in parts else None
        self._link = options.link
        self._ended = threading.Event()
        self._trouble: ArboledaError | None = None
        self._started: list[Part] = []
        self._parts: list[Part] = [self._broker]
        if "orchestrator" in parts:
            self._state.open()
        try:
            self._build(set(parts))
        except BaseException:
            self._state.close()
            raise

    @property
    def notes(self) -> list[str]:
        """What a person should know of this start, a line each."""
        notes = list(self._link.notes) if self._link else []
        notes.append(f"MQTT broker: {self._broker.address}")
        if self._web is not None:
            notes.append(f"HTTP API: http://127.0.0.1:{self._web.port}/api/plant")
        return notes

    def start(self) -> None:
        """Start every part in order; where one cannot, nothing is left running."""
        try:
            for part in self._parts:
                self._started.append(part)
                part.start()
        except BaseException:
            self.stop()
            raise

    def end(self) -> None:
        """Let `wait` return."""
        self._ended.set()

    def wait(self) -> None:
        """Block until `end`; ArboledaError where a part broke down."""
        self._ended.wait()
        if self._trouble is not None:
            raise self._trouble

    def stop(self) -> None:
        """Halt the robots, then end the parts in reverse order; idempotent."""
        while self._started:
            self._started.pop().stop()
        self._state.close()

    def listen(self, *listeners: Callable[[TaskChanged], None]) -> None:
        """Have every change of a task told, in the plant's thread; before `start`."""
        self._plant.listeners.extend(listeners)

    def watch(self, watcher: Callable[[dict[str, Any]], None]) -> None:
        """Have a snapshot told whenever more than a position changed, in the plant's thread; before `start`."""
        self._plant.watchers.append(watcher)

    def submit(self, text: str) -> Future[TaskChanged]:
        return self._plant.submit(text)

    def snapshot(self) -> dict[str, Any]:
        return self._plant.snapshot()

    @property
    def _plant(self) -> Orchestrator:
        if self.orchestrator is None:
            raise ArboledaError("there is no orchestrator in this process")
        return self.orchestrator

    def _build(self, parts: set[str]) -> None:
        now, bridge = int(time.time()), None
        if "devices" in parts:
            scout = "broker" not in parts
            self._parts.append(DevicesPart(self.model, now, self._broker, self._crash, scout=scout))
        if "bridge" in parts:
            bridge = BridgePart(self.model, now, self._broker, self._crash)
            self._parts.append(bridge)
        if "orchestrator" in parts:
            self.orchestrator = Orchestrator(self.model, self._state.next_epoch(now), self._crash)
            self._parts.append(self.orchestrator)
        if self._web is not None:
            self._parts.append(self._web)
        self._join(bridge, self._link)

    def _join(self, bridge: BridgePart | None, link: Any | None) -> None:
        """Join plant and bridge: over ROS 2 where there is a link, else directly."""
        plant = self.orchestrator
        if link is None:
            if plant is not None and bridge is not None:
                _refuse_ros_robots(self.model)
                plant.connect(bridge)
                bridge.connect(plant.loop.post)
            return
        if bridge is not None:
            bridge.connect(link.bridge(self.model, bridge.loop.post, time.monotonic).send)
        if plant is not None:
            plant.connect_ros(link.orchestrator(self.model, plant.loop.post, time.monotonic))
        self._parts.insert(1, RosPart(link))

    def _crash(self, name: str, error: Exception) -> None:
        self._trouble = self._trouble or ArboledaError(f"{name}: {error}")
        LOG.debug("%s broke down", name, exc_info=error)
        self._ended.set()


class WebPart:
    """The HTTP API as a part; the state directory says where it listens."""

    def __init__(self, app: App, state: StateDir) -> None:
        self.port = 0
        self._state = state
        self._api = Api(app.snapshot, lambda text: _plain(app.submit(text)))

    def start(self) -> None:
        self.port = self._api.start()
        self._state.announce(self.port)

    def stop(self) -> None:
        self._api.stop()


def _plain(answer: Future[TaskChanged]) -> Future[dict[str, Any]]:
    plain: Future[dict[str, Any]] = Future()
    answer.add_done_callback(lambda known: plain.set_result(view.change(known.result())))
    return plain


class RosPart:
    """The ROS 2 link as a part."""

    def __init__(self, link: Any) -> None:
        self._link = link

    def start(self) -> None:
        self._link.start()

    def stop(self) -> None:
        self._link.close()


def build(model: PlantModel, parts: Collection[str], options: Options) -> App:
    """A plant of the named PARTS; StartError where they cannot be put together."""
    return App(model, parts, options)


def address(text: str) -> Address:
    """HOST:PORT or HOST; StartError for anything else."""
    host, colon, port = text.rpartition(":")
    if not colon:
        host, port = text, str(MQTT_PORT)
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise StartError(f"'{text}' is not a broker address; write HOST:PORT, e.g. 127.0.0.1:{MQTT_PORT}")
    return Address(host=host.strip("[]"), port=int(port))


def check_rate(rate: float) -> float:
    """The rate itself; StartError where it makes no sense."""
    if not 0.1 <= rate <= 100:
        raise StartError(f"{rate:g} is not a rate; allowed: 0.1 to 100")
    return rate


def at_rate(model: PlantModel, rate: float) -> PlantModel:
    """The same plant with robots `rate` times as fast, and accelerating so that every ramp keeps its shape."""
    check_rate(rate)
    return replace(model, cells=tuple(_cell_at_rate(cell, rate) for cell in model.cells))


def _cell_at_rate(cell: Cell, rate: float) -> Cell:
    arm: Arm = replace(cell.arm, joints=tuple(_joint_at_rate(joint, rate) for joint in cell.arm.joints))
    return replace(cell, arm=arm, mobile=replace(cell.mobile, speed=cell.mobile.speed * rate))


def _joint_at_rate(joint: Joint, rate: float) -> Joint:
    return replace(joint, speed=joint.speed * rate, acceleration=joint.acceleration * rate**2)


def _refuse_ros_robots(model: PlantModel) -> None:
    names = [robot.name for robot in model.robots.values() if robot.link is Link.ROS]
    if names:
        raise StartError(f"{', '.join(names)}: link ros needs ROS 2; start without --no-ros")
