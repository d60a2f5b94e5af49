"""Trial of a board: a judge on a real broker, a client for messages, and one that takes the board's place."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from uuid import uuid4

from arboleda.adapters import clock
from arboleda.adapters.broker_login import Address, Credentials
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.drivers import Robot
from arboleda.extension import StartError
from arboleda.runtime.interrupts import until
from arboleda.runtime.loop import Loop
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery, Publication

from .bench import Jostle, Send
from .judge import Judge

CONNECT_S = 5.0
TAKE_PLACE_S = 3.0


class Trial:
    """Trial: runs a judge to its end; `on_step` is called with it after every step, in the loop's thread."""

    def __init__(
        self,
        robot: Robot,
        broker: Address,
        credentials: Credentials | None,
        on_step: Callable[[Judge], None],
    ) -> None:
        self._name = robot.mqtt
        self._broker = broker
        self._credentials = credentials
        self._on_step = on_step
        self._over = threading.Event()
        self._there = threading.Event()
        self._crashed: BaseException | None = None
        self._places: list[threading.Thread] = []
        self.judge = Judge(robot, epoch=int(time.time()), now=clock.seconds())
        self._loop: Loop[Delivery, Send | Jostle] = Loop(
            "conformance",
            self.judge,
            self._carry_out,
            on_crash=self._crash,
            on_step=lambda *_: self._stepped(),
        )
        channels = (Channel.TELEMETRY, Channel.PRESENCE)
        self._client = MqttClient(
            f"arboleda_conformance_{uuid4().hex[:8]}",
            broker,
            subscriptions=[topic(robot.mqtt, channel) for channel in channels],
            on_event=self._hear,
            credentials=credentials,
        )

    def run(self) -> None:
        """Run until all is known; StartError without a broker. The board is halted in any case."""
        self._client.start()
        try:
            if not self._there.wait(CONNECT_S):
                raise StartError(f"the MQTT broker at {self._broker} was not reached within {CONNECT_S:g} s")
            self._loop.start()
            until(self._over)
        finally:
            self._loop.stop()
            self._halt()
            for place in self._places:
                place.join()
            self._client.close()
        if self._crashed is not None:
            raise self._crashed

    def _hear(self, event: Delivery | Connection) -> None:
        if isinstance(event, Delivery):
            self._loop.post(event)
        elif event.up:
            self._there.set()

    def _carry_out(self, message: Send | Jostle) -> None:
        if isinstance(message, Jostle):
            self._places.append(threading.Thread(target=self._take_place, name="jostle"))
            self._places[-1].start()
            return
        where = topic(self._name, message.channel)
        qos = 0 if message.channel is Channel.BEAT else 1
        self._client.publish(
            Publication(topic=where, payload=message.payload, qos=qos, retain=message.retain)
        )

    def _take_place(self) -> None:
        """Connect by the board's client id, and leave at once: the broker drops the board, which returns."""
        taken = threading.Event()
        rival = MqttClient(
            self._name,
            self._broker,
            on_event=lambda event: taken.set() if isinstance(event, Connection) else None,
            credentials=self._credentials,
            announce=False,
        )
        rival.start()
        taken.wait(TAKE_PLACE_S)
        rival.close()

    def _halt(self) -> None:
        """Halt the board with `paro` 2, which needs no number; without a connection its own watch does it."""
        try:
            halt = Publication(topic=topic(self._name, Channel.STOP), payload=b'{"paro":2,"seq":1,"epoca":1}')
            self._client.publish(halt)
        except NotConnected:
            return

    def _stepped(self) -> None:
        self._on_step(self.judge)
        if self.judge.over:
            self._over.set()

    def _crash(self, name: str, error: BaseException) -> None:
        self._crashed = error
        self._over.set()
