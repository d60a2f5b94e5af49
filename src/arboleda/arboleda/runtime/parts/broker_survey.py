"""A look at a broker before virtual boards join it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from uuid import uuid4

from arboleda.adapters.mqtt import MqttClient
from arboleda.model.errors import StartError
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Connection, Delivery

from .part import BrokerAddress, Crash

LOOK_S = 0.6  # boards that live send telemetry every 0.1 s


class BrokerSurvey:
    """Listens on a broker for boards that live there already; calls `clear` once if there are none."""

    def __init__(
        self, broker: BrokerAddress, boards: Sequence[str], clear: Callable[[], None], crash: Crash
    ) -> None:
        self._clear = clear
        self._crash = crash
        self._timer: threading.Timer | None = None
        self._boards_there: set[str] = set()
        self._client = MqttClient(
            f"arboleda_lookout_{uuid4().hex[:8]}",
            broker.address,
            subscriptions=[topic(board, Channel.TELEMETRY) for board in boards],
            on_event=self._note,
            credentials=broker.credentials,
        )

    def start(self) -> None:
        self._client.start()

    def stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._client.close()

    def _note(self, event: Delivery | Connection) -> None:
        if isinstance(event, Delivery):
            self._boards_there.add(event.topic.split("/")[0])
        elif event.up and self._timer is None:
            self._timer = threading.Timer(LOOK_S, self._decide)
            self._timer.daemon = True
            self._timer.start()

    def _decide(self) -> None:
        self._client.close()
        if not self._boards_there:
            self._clear()
            return
        names = ", ".join(sorted(self._boards_there))
        sentence = f"{names} already live on this broker, virtual boards of the same names would fight them"
        self._crash("devices", StartError(f"{sentence}; use --boards real"))
