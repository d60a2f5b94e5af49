"""The virtual boards in one loop, each with an MQTT client of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from itertools import count
from typing import Any, Protocol, TypeVar

from arboleda.adapters import clock
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.model.plant_model import PlantModel
from arboleda.sim.devices import Devices, FromBoard, ToBoard
from arboleda.wire.payloads import Presence, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication

from ..loop import Loop, Machine
from .broker_survey import BrokerSurvey
from .part import Broker, BrokerAddress, Crash, Part, not_sent

Seen = TypeVar("Seen")


class DeviceBench(Protocol):
    """Bench for virtual boards: makes of them a machine that does more to them than let time pass."""

    def __call__(self, model: PlantModel, devices: Devices, *, now: float) -> Machine[Any, Any]: ...


Survey = Callable[[Sequence[str], Callable[[], None]], Part]
"""Maker of a look at a broker for boards of these names, which calls the function where there are none."""


class FirmwareBoards(Protocol):
    """Maker of boards that are the firmware's, as programs: the robots whose they are, and their part."""

    def __call__(
        self, model: PlantModel, broker: Broker, crash: Crash, survey: Survey | None
    ) -> tuple[Collection[str], Part]: ...


class DevicesPart:
    """The virtual boards in one loop, each with an MQTT client and a last will of its own.

    `joined` is called when they go to the broker: before that, a command might reach the boards of another
    plant. A `bench` may take more events than they, and have messages of its own, which are `noted`.
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
        bench: DeviceBench | None = None,
    ) -> None:
        self._joined = joined
        self._broker = broker
        self._crash = crash
        self._scout = scout
        self._version = model.mqtt_version
        boot_ids = count(first_boot).__next__
        self.noted: Callable[[Any], None] = _ignore  # called in the loop's thread
        now = clock.seconds()
        self._devices = Devices(model, now=now, boot_ids=boot_ids, elsewhere=elsewhere)
        machine = self._devices if bench is None else bench(model, self._devices, now=now)
        self._clients: dict[str, MqttClient] = {}
        self._lock = threading.Lock()
        self._lookout: BrokerSurvey | None = None
        self.loop: Loop[Any, Any] = Loop(
            "devices", machine, self._send, on_crash=crash, on_send_error=not_sent
        )

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

    def befall(self, fault: object) -> None:
        """Have a Reboot or an Alarm befall a board, or what the bench takes; from any thread."""
        self.loop.post(fault)

    def read(self, look: Callable[[Any], Seen]) -> tuple[float, Seen]:
        """The time, and what is seen at the bench between two steps; from any thread."""
        seen: Seen = self.loop.read(look)
        return clock.seconds(), seen

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

    def _send(self, message: Any) -> None:
        if not isinstance(message, FromBoard):
            self.noted(message)
            return
        client = self._clients.get(message.board)
        if client is not None:
            client.publish(message.publication)


def _ignore(note: object) -> None: ...
