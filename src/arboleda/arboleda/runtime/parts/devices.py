"""The virtual boards in one loop, each with an MQTT client of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection
from contextlib import suppress
from itertools import count
from typing import Any

from arboleda.adapters import clock
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.model.plant_model import PlantModel
from arboleda.sim.devices import Alarm, Devices, FromBoard, Reboot, ToBoard
from arboleda.simulator.fault_bench import FaultBench, MishapBegins, MishapEnds, MishapNote, MishapOver
from arboleda.wire.payloads import Presence, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from ..loop import Loop
from .broker_survey import BrokerSurvey
from .part import BrokerAddress, Crash, not_sent


class DevicesPart:
    """The virtual boards in one loop, each with an MQTT client and a last will of its own.

    `joined` is called when they go to the broker: before that, a command might reach the boards of another
    plant.
    """

    def __init__(
        self,
        model: PlantModel,
        first_boot: int,
        broker: BrokerAddress,
        crash: Crash,
        *,
        scout: bool,
        joined: Callable[[], None],
        elsewhere: Collection[str] = (),
    ) -> None:
        self._joined = joined
        self._broker = broker
        self._crash = crash
        self._scout = scout
        self._version = model.mqtt_version
        boot_ids = count(first_boot).__next__
        self.noted: Callable[[MishapNote | MishapOver], None] = _ignore  # called in the loop's thread
        now = clock.seconds()
        self._devices = Devices(model, now=now, boot_ids=boot_ids, elsewhere=elsewhere)
        bench = FaultBench(model, self._devices, now=now)
        self._clients: dict[str, MqttClient] = {}
        self._lock = threading.Lock()
        self._lookout: BrokerSurvey | None = None
        self.loop: Loop[Any, Any] = Loop("devices", bench, self._send, on_crash=crash, on_send_error=not_sent)

    def start(self) -> None:
        """Join the broker; with `scout`, only after it was seen that no real board has these names."""
        self.loop.start()
        if self._scout:
            self._lookout = BrokerSurvey(self._broker, tuple(self._devices.boards), self._join, self._crash)
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

    @property
    def boards(self) -> tuple[str, ...]:
        """The boards, by MQTT name."""
        return tuple(self._devices.boards)

    def befall(self, fault: Reboot | Alarm | MishapBegins | MishapEnds) -> None:
        """Have something go wrong with a board, or be over; from any thread."""
        self.loop.post(fault)

    def begun(self) -> tuple[float, list[MishapNote]]:
        """The time, and the mishaps that go on; from any thread."""
        return clock.seconds(), self.loop.read(lambda bench: list(bench.begun.values()))

    def _join(self) -> None:
        with self._lock:
            for number, board in enumerate(self._devices.boards):
                self._clients[board] = self._client(board, announce=number == 0)
            for client in self._clients.values():
                client.start()
        self._joined()

    def _client(self, board: str, *, announce: bool) -> MqttClient:
        gone = Publication(topic=topic(board, Channel.PRESENCE), payload=encode(Presence(online=False)))
        return MqttClient(
            board,
            self._broker.address,
            subscriptions=self._devices.subscriptions(board),
            on_event=lambda event: self.loop.post(ToBoard(board=board, event=event)),
            will=gone._replace(retain=True),
            credentials=self._broker.credentials,
            version=self._version,
            announce=announce,
        )

    def _leave(self, board: str, client: MqttClient) -> None:
        gone = encode(Presence(online=False))
        with suppress(NotConnected):  # then there is nobody to tell
            client.publish(Publication(topic=topic(board, Channel.PRESENCE), payload=gone, retain=True))
        client.close()

    def _send(self, message: FromBoard | MishapNote | MishapOver) -> None:
        if isinstance(message, MishapNote | MishapOver):
            self.noted(message)
            return
        client = self._clients.get(message.board)
        if client is not None:
            client.publish(message.publication)


def _ignore(note: MishapNote | MishapOver) -> None: ...
