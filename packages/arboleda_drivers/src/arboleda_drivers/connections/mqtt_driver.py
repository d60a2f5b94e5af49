"""Driver over MQTT: one client at a broker, whose thread hears, and a thread that keeps deadlines."""

from __future__ import annotations

import logging
import secrets
import threading
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

from arboleda.adapters.broker_login import address, login
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.adapters.rate_limit import RateLimit
from arboleda.drivers import Clock, Command, Hear, NotSent, Robot, plain
from arboleda.wire.transport import Connection, Delivery, Publication

LOG = logging.getLogger("arboleda.drivers.mqtt")
LONGEST_TOPIC = 300
LEAST_WAIT_S = 0.01
HERE = "127.0.0.1"  # the broker where no plant has one


class MqttDriver(ABC):
    """Driver over MQTT, at the plant's broker without a `broker`. Each method of a subclass is called while
    `lock` is held."""

    def __init__(self, broker: str, version: str = "3.1.1") -> None:
        self._broker, self._version = broker, version
        self._plant: Any = None  # the plant's broker
        self.lock = threading.Lock()  # guards the machines, and the order of their messages
        self._ending = threading.Event()
        self._seldom = RateLimit()
        self._client: MqttClient | None = None
        self._ticking: threading.Thread | None = None

    @abstractmethod
    def begin(self, devices: Sequence[Robot], mark: str, broker: str) -> Sequence[str]:
        """Make the machines of the devices; returns the topics to subscribe to.

        `mark` sets this start apart from any other; `broker` is the address for sentences.
        """

    @abstractmethod
    def connected(self, *, up: bool) -> None:
        """Note that the broker is connected, or is lost."""

    @abstractmethod
    def take(self, message: Delivery) -> None:
        """Take a message."""

    @abstractmethod
    def tick(self) -> float:
        """Do what is due; returns for how long nothing is, s."""

    @abstractmethod
    def give(self, command: Command) -> None:
        """Give a command; raises NotSent."""

    def use_broker(self, broker: Any) -> None:
        self._plant = None if self._broker else broker

    def start(self, devices: Sequence[Robot], hear: Hear, clock: Clock) -> None:
        self.hear, self.clock = hear, clock
        mark, plant = secrets.token_hex(4), self._plant
        at = address(self._broker or HERE) if plant is None else plant.address
        topics = self.begin(devices, mark, str(at))
        self._client = MqttClient(
            f"arboleda-{mark}",
            at,
            on_event=self._handle,
            subscriptions=topics,
            clock=clock,
            credentials=login() if plant is None else plant.credentials,
            version=self._version,
        )
        self._client.start()
        name = "-".join(("mqtt", devices[0].name))
        self._ticking = threading.Thread(target=self._tick, name=name, daemon=True)
        self._ticking.start()

    def send(self, command: Command) -> None:
        with self.lock:
            self.give(command)

    def stop(self) -> None:
        self._ending.set()
        if self._client is not None:
            self._client.close()
        if self._ticking is not None:
            self._ticking.join()

    def publish(self, message: Publication) -> None:
        """Send now; raises NotSent where the broker is not connected."""
        assert self._client is not None
        try:
            self._client.publish(message)
        except NotConnected as error:
            raise NotSent(str(error)) from error

    def warn(self, what: str) -> None:
        """Say it in the log, once in a while."""
        if self._seldom.is_due(what, self.clock()):
            LOG.warning("%s", plain(what, LONGEST_TOPIC))

    def _tick(self) -> None:
        while not self._ending.is_set():
            with self.lock:
                wait_s = self.tick()
            self._ending.wait(max(LEAST_WAIT_S, wait_s))

    def _handle(self, event: Delivery | Connection) -> None:
        with self.lock:
            if isinstance(event, Connection):
                self.connected(up=event.up)
            elif len(event.topic) <= LONGEST_TOPIC:
                self.take(event)
