"""The MQTT broker of a plant: its own, or another."""

from __future__ import annotations

from typing import TYPE_CHECKING

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import MQTT_PORT, TLS_PORT, Address, Credentials
from arboleda.model.errors import StartError

if TYPE_CHECKING:
    from arboleda.adapters.server_tls import ServerTls


class OtherBroker:
    """A broker that somebody else runs: nothing to start."""

    def __init__(self, address: Address, credentials: Credentials | None) -> None:
        self.address = address
        self.secure = address.tls is not None
        self.credentials = credentials

    def start(self) -> None: ...
    def stop(self) -> None: ...


class OwnBroker:
    """The embedded broker; `found_by_port` where clients outside this process must find it."""

    def __init__(
        self,
        host: str,
        users: dict[str, str] | None,
        boards: frozenset[str],
        *,
        found_by_port: bool,
        tls: ServerTls | None = None,
    ) -> None:
        self.address = Address(host=host, port=TLS_PORT if tls else MQTT_PORT)
        self.secure = tls is not None
        self._tls = tls
        self.credentials: Credentials | None = None
        self._users = users
        self._boards = boards
        self._found_by_port = found_by_port
        self._broker: EmbeddedBroker | None = None

    def start(self) -> None:
        """Take the port of MQTT; where it is taken, any free one, unless others must find it."""
        try:
            self._listen(self.address.port)
        except StartError:
            if self._found_by_port:
                raise
            self._listen(0)

    def stop(self) -> None:
        if self._broker is not None:
            self._broker.stop()

    def _listen(self, port: int) -> None:
        host = self.address.host
        broker = EmbeddedBroker(host, port, users=self._users, boards=self._boards, tls=self._tls)
        self.address = broker.start()
        self.credentials = broker.credentials
        self._broker = broker
