"""Real brokers on free ports, clients whose events can be waited for, and certificates of a lab."""

from __future__ import annotations

import socket
import struct
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker_login import CA, CERTIFICATE, KEY, Address
from arboleda.adapters.mqtt import MqttClient
from arboleda.wire.transport import Connection, Delivery

from ..patience import PATIENCE_S
from ..tls_lab import Lab


class Inbox(list):
    """A list of events that another thread fills."""

    def __init__(self) -> None:
        self._changed = threading.Condition()

    def put(self, event: Any) -> None:
        with self._changed:
            self.append(event)
            self._changed.notify_all()

    def wait(self, arrived: Callable[[Inbox], Any], timeout: float = PATIENCE_S) -> Any:
        """The first true value of `arrived(inbox)`."""
        with self._changed:
            if not self._changed.wait_for(lambda: arrived(self), timeout):
                pytest.fail(f"not within {timeout} s; so far: {list(self)}")
            return arrived(self)

    @property
    def deliveries(self) -> list[Delivery]:
        return [event for event in self if isinstance(event, Delivery)]

    @property
    def payloads(self) -> list[bytes]:
        return [delivery.payload for delivery in self.deliveries]

    @property
    def links(self) -> list[bool]:
        return [event.up for event in self if isinstance(event, Connection)]


class Peer:
    """An MqttClient with its inbox."""

    def __init__(self, client_id: str, address: Address, **options: Any) -> None:
        self.address = address
        self.inbox = Inbox()
        self.client = MqttClient(client_id, address, on_event=self.inbox.put, **options)
        self.client.start()

    def up(self) -> Peer:
        self.inbox.wait(lambda inbox: inbox.links[-1:] == [True])
        return self


class RawPeer:
    """An MQTT 3.1.1 client of a few bytes, which can break off without a word."""

    def __init__(self, address: Address, client_id: str, *, will: tuple[str, bytes]) -> None:
        flags = 0x02 | 0x2C  # will, QoS 1, retained
        rest = text(client_id) + text(will[0]) + text(will[1])
        self.socket = socket.create_connection((address.host, address.port), timeout=PATIENCE_S)
        self._send(0x10, text("MQTT") + bytes((4, flags)) + b"\0\0" + rest)
        assert self.socket.recv(4)[3:] == b"\0", "it is accepted"

    def _send(self, kind: int, body: bytes) -> None:
        assert len(body) < 128
        self.socket.sendall(bytes((kind, len(body))) + body)

    def publish(self, topic: str, payload: bytes, *, retain: bool = False) -> None:
        """QoS 0."""
        self._send(0x31 if retain else 0x30, text(topic) + payload)

    def close(self) -> None:
        """Break off without DISCONNECT."""
        self.socket.close()


def text(value: str | bytes) -> bytes:
    raw = value.encode() if isinstance(value, str) else value
    return struct.pack("!H", len(raw)) + raw


class Mosquitto:
    """The Debian package's broker on a port that survives a restart."""

    def __init__(self, program: str, port: int, folder: Path, *options: str) -> None:
        self.address = Address(host="127.0.0.1", port=port)
        self._config = folder / "mosquitto.conf"
        lines = (
            "set_tcp_nodelay true",
            f"listener {port} 127.0.0.1",
            *(options or ("allow_anonymous true",)),
        )
        self._config.write_text("\n".join(lines) + "\n")
        self._program = program
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        self._process = subprocess.Popen(
            [self._program, "-c", str(self._config)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        end = time.monotonic() + PATIENCE_S
        while True:
            try:
                socket.create_connection((self.address.host, self.address.port), timeout=1).close()
            except ConnectionRefusedError:
                assert time.monotonic() < end, "mosquitto does not listen"
                time.sleep(0.02)
            else:
                return

    def stop(self) -> None:
        if self._process is not None:
            self._process.terminate()
            self._process.wait(PATIENCE_S)
            self._process = None


def said(caplog: pytest.LogCaptureFixture, words: str) -> str:
    """A line of the log with these words."""
    end = time.monotonic() + PATIENCE_S
    while not (found := [line for line in caplog.messages if words in line]):
        assert time.monotonic() < end, f"no {words!r} in {caplog.messages}"
        time.sleep(0.01)
    return found[0]


@pytest.fixture(autouse=True)
def patient_messages(monkeypatch: pytest.MonkeyPatch) -> None:
    """What a client of this process sends leaves it, however long the process had to wait for a core."""
    monkeypatch.setattr("arboleda.adapters.mqtt.WAITS_S", PATIENCE_S)


@pytest.fixture(scope="session")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Lab:
    return Lab(tmp_path_factory.mktemp("tls") / "lab")


@pytest.fixture
def trusts(monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
    """What the environment says of certificates."""

    def set_(authority: Path | None = None, certificate: Path | None = None, key: Path | None = None) -> None:
        for name, file in ((CA, authority), (CERTIFICATE, certificate), (KEY, key)):
            monkeypatch.setenv(name, str(file or ""))

    set_()
    return set_


@pytest.fixture
def mosquitto(
    require: Callable[[str], str], free_port: int, tmp_path: Path
) -> Iterator[Callable[..., Mosquitto]]:
    """Makes a mosquitto, not yet started; further lines of its configuration as arguments."""
    made: list[Mosquitto] = []

    def make(*options: str) -> Mosquitto:
        made.append(Mosquitto(require("mosquitto"), free_port, tmp_path, *options))
        return made[-1]

    yield make
    for broker in made:
        broker.stop()


@pytest.fixture
def peer() -> Iterator[Callable[..., Peer]]:
    """Makes Peers and closes them."""
    made: list[Peer] = []

    def make(client_id: str, address: Address, **options: Any) -> Peer:
        made.append(Peer(client_id, address, **options))
        return made[-1]

    yield make
    for one in made:
        one.client.close()


@pytest.fixture
def raw_peer() -> Iterator[Callable[..., RawPeer]]:
    """Makes RawPeers and breaks them off."""
    made: list[RawPeer] = []

    def make(*args: Any, **options: Any) -> RawPeer:
        made.append(RawPeer(*args, **options))
        return made[-1]

    yield make
    for one in made:
        one.close()
