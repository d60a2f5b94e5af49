"""MQTT clients of virtual boards, on whichever broker there is."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.adapters.broker_login import Address
from arboleda.adapters.mqtt import MqttClient, NotConnected
from arboleda.sim.devices import Devices, FromBoard, ToBoard
from arboleda.wire.payloads import Presence, encode
from arboleda.wire.topics import Channel, topic
from arboleda.wire.transport import Publication


class BoardClients:
    """A client for each board; `post` takes what they hear."""

    def __init__(self, devices: Devices, post: Callable[[ToBoard], None]) -> None:
        self._devices = devices
        self._post = post
        self._clients: dict[str, MqttClient] = {}

    def join(self, broker: Address) -> None:
        """Go to a broker at once, as a board does that happens to try just then."""
        self.leave()
        self._clients = {board: self._client(board, broker) for board in self._devices.boards}
        for client in self._clients.values():
            client.start()

    def leave(self) -> None:
        """Try no more: where one broker was, that of another plant may be next."""
        for client in self._clients.values():
            client.close()
        self._clients = {}

    def send(self, message: FromBoard) -> None:
        """Publish what a board sends; while it has no broker that is lost, as with a real one."""
        client = self._clients.get(message.board)
        if client is not None:
            client.publish(message.publication)

    def _client(self, board: str, broker: Address) -> MqttClient:
        gone = Publication(
            topic=topic(board, Channel.PRESENCE), payload=encode(Presence(online=False)), retain=True
        )
        return MqttClient(
            board,
            broker,
            subscriptions=self._devices.subscriptions(board),
            on_event=lambda event: self._post(ToBoard(board=board, event=event)),
            will=gone,
            announce=False,
        )


def forget_unsent(message: FromBoard, error: Exception) -> None:
    """Forget what a board could not send for want of a broker; raises any other error."""
    if not isinstance(error, NotConnected):
        raise error
