"""The MQTT broker of a plant: its own, or another."""

from __future__ import annotations

import os

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.mqtt import Address, Credentials
from arboleda.core.errors import StartError

MQTT_PORT = 1883
USER, PASSWORD = "ARBOLEDA_MQTT_USER", "ARBOLEDA_MQTT_PASSWORD"  # anybody can read a command line


def login() -> Credentials | None:
    """Who this process is for a broker that asks, from the environment; None where it names no user."""
    user = os.environ.get(USER)
    return Credentials(user=user, password=os.environ.get(PASSWORD, "")) if user else None


class OtherBroker:
    """A broker that somebody else runs: nothing to start."""

    def __init__(self, address: Address, credentials: Credentials | None) -> None:
        self.address = address
        self.credentials = credentials

    def start(self) -> None: ...
    def stop(self) -> None: ...


class OwnBroker:
    """The embedded broker; `found_by_port` where clients outside this process must find it."""

    def __init__(
        self, host: str, users: dict[str, str] | None, boards: frozenset[str], *, found_by_port: bool
    ) -> None:
        self.address = Address(host=host, port=MQTT_PORT)
        self.credentials: Credentials | None = None
        self._users = users
        self._boards = boards
        self._found_by_port = found_by_port
        self._broker: EmbeddedBroker | None = None

    def start(self) -> None:
        """Take port 1883; where it is taken, any free one, unless others must find it."""
        try:
            self._listen(MQTT_PORT)
        except StartError:
            if self._found_by_port:
                raise
            self._listen(0)

    def stop(self) -> None:
        if self._broker is not None:
            self._broker.stop()

    def _listen(self, port: int) -> None:
        host = self.address.host
        broker = EmbeddedBroker(host, port, users=self._users, boards=self._boards)
        self.address = broker.start()
        self.credentials = broker.credentials
        self._broker = broker


def address(text: str) -> Address:
    """HOST:PORT or HOST; StartError for anything else."""
    host, colon, port = text.rpartition(":")
    if not colon:
        host, port = text, str(MQTT_PORT)
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise StartError(f"'{text}' is not a broker address; write HOST:PORT, e.g. 127.0.0.1:{MQTT_PORT}")
    return Address(host=host.strip("[]"), port=int(port))
