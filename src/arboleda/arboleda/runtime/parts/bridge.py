"""The bridge in its loop, between the plant and one MQTT client."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any
from uuid import uuid4

from arboleda.adapters import clock
from arboleda.adapters.mqtt import MqttClient
from arboleda.adapters.rate_limit import RateLimit
from arboleda.model.commands import Command
from arboleda.model.messages import Heartbeat, Notice, Report
from arboleda.model.plant_model import PlantModel
from arboleda.wire.board import Message
from arboleda.wire.bridge import Bridge, Leaving
from arboleda.wire.hop import FromPlant
from arboleda.wire.rejections import ForeignCommand, Rejection
from arboleda.wire.transport import Connection, Delivery

from ..loop import Loop
from .part import BrokerAddress, Crash, not_sent

LOG = logging.getLogger("arboleda.bridge")


class BridgePart:
    """The bridge in its loop, with its MQTT client; `connect` its plant side before `start`.

    With `waits` it goes to the broker at `join`, not at `start`; with `has_lease` it yields no board.
    """

    def __init__(
        self,
        model: PlantModel,
        epoch: int,
        broker: BrokerAddress,
        crash: Crash,
        *,
        waits: bool = False,
        has_lease: bool = False,
    ) -> None:
        self._broker = broker
        self._waits = waits
        self._bridge = Bridge(model, epoch=epoch, now=clock.seconds(), has_lease=has_lease)
        self._version = model.mqtt_version
        self._client: MqttClient | None = None
        self._lock = threading.Lock()
        self._ended = False
        self._leads = True
        self._report: Callable[[Report], None] = lambda report: None
        self._tell_link: Callable[[bool, str], None] = _nobody
        self._tell: Callable[[Rejection | ForeignCommand], None] = lambda news: None
        self._seldom = RateLimit()
        self.loop: Loop[Any, Any] = Loop(
            "bridge", self._bridge, self._send, on_crash=crash, on_send_error=not_sent
        )

    def connect(
        self,
        report: Callable[[Report], None],
        tell_link: Callable[[bool, str], None] | None = None,
        tell: Callable[[Rejection | ForeignCommand], None] | None = None,
    ) -> None:
        """Connect the receivers of reports, of the broker's state with its address, and of refused commands
        and those of others."""
        self._report = report
        self._tell_link = tell_link or _nobody
        self._tell = tell or self._tell

    def send(self, message: Command | Notice) -> None:
        """The plant's port where plant and bridge share a process."""
        if isinstance(message, Command | Heartbeat):
            self.loop.post(FromPlant(at=clock.seconds(), message=message))

    def start(self) -> None:
        self.loop.start()
        if not self._waits:
            self.join()

    def join(self) -> None:
        """Go to the broker; from any thread, after the end it does nothing."""
        with self._lock:
            if self._ended:
                return
            self._client = MqttClient(
                f"arboleda_bridge_{uuid4().hex[:8]}",
                self._broker.address,
                subscriptions=self._bridge.subscriptions,
                on_event=self._post,
                credentials=self._broker.credentials,
                version=self._version,
            )
            self._tell_link(False, str(self._broker.address))
            self._client.start()

    def links(self) -> tuple[bool, dict[str, dict[str, Any]]]:
        """The state of the broker's connection, and for each robot the refused messages of its board: count,
        last sentence."""

        def look(bridge: Bridge) -> tuple[bool, dict[str, dict[str, Any]]]:
            counted = bridge.counters.items()
            return bridge.connected, {
                robot: {"count": counters.refused, "last": counters.last or None}
                for robot, counters in counted
            }

        return self.loop.read(look)

    def leave_robots(self) -> None:
        """Publish nothing more, and let `stop` halt no robot, as another process leads them now."""
        self._leads = False

    def stop(self) -> None:
        """Halt what still moves, then leave; the plant may be another process that has already ended."""
        if self._leads:
            self.loop.post(Leaving(at=clock.seconds()))
        self.loop.stop()
        with self._lock:
            self._ended = True
        if self._client is not None:
            self._client.close()

    def _post(self, event: Delivery | Connection) -> None:
        if isinstance(event, Connection):
            self._tell_link(event.up, str(self._broker.address))
        self.loop.post(event)

    def _send(self, message: Message) -> None:
        if isinstance(message, Report):
            self._report(message)
        elif isinstance(message, Rejection | ForeignCommand):
            if self._seldom.is_due(message.sentence, message.at):
                LOG.warning("%s", message.sentence)
            self._tell(message)
        elif self._client is not None and self._leads:
            self._client.publish(message, self._bridge.now)


def _nobody(up: bool, broker: str) -> None: ...
