"""The plant's own broker on real sockets: it opens to nobody by mistake, and nothing of it stays behind.

What it does for each client is tried without a network, in tests/unit/adapters/mqtt_broker.
"""

from __future__ import annotations

import socket
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import Credentials
from arboleda.adapters.mqtt_broker.access import Access, ClientIdentity, Role
from arboleda.model.errors import StartError
from arboleda.wire.transport import Publication

from .conftest import said

USERS = {"ra_1": "one", "ra_10": "ten", "ana": "look"}
BOARDS = frozenset({"ra_1", "ra_10"})
RIGHT = Access.login


@pytest.fixture
def broker() -> Iterator[EmbeddedBroker]:
    made = EmbeddedBroker(port=0)
    yield made
    made.stop()


@pytest.fixture
def guarded() -> Iterator[EmbeddedBroker]:
    made = EmbeddedBroker(port=0, users=USERS, boards=BOARDS)
    yield made
    made.stop()


@pytest.fixture
def plant(guarded: EmbeddedBroker, peer: Callable[..., Any]) -> Any:
    """The plant's own client, which hears everything."""
    return peer("bridge", guarded.start(), credentials=guarded.credentials, subscriptions=["#"]).up()


def login(user: str) -> Credentials:
    return Credentials(user=user, password=USERS[user])


def message(topic: str, payload: bytes = b"x", **options: Any) -> Publication:
    return Publication(topic=topic, payload=payload, **options)


def test_a_board_reads_and_writes_only_what_is_its_own(
    plant: Any, peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    board = peer("ra_1", plant.address, credentials=login("ra_1"), subscriptions=["ra_1/juntas"]).up()
    for topic in ("ra_1/juntas", "ra_10/sensores", "ra_1/sensores"):
        board.client.publish(message(topic))
    plant.inbox.wait(lambda inbox: inbox.deliveries)
    plant.client.publish(message("ra_1/juntas", b"goal"))
    board.inbox.wait(lambda inbox: inbox.deliveries)
    assert plant.inbox.deliveries[0].topic == "ra_1/sensores" and board.inbox.payloads == [b"goal"]
    peer("curious", plant.address, credentials=login("ra_1"), subscriptions=["#"])
    said(caplog, "refused to subscribe curious to #; trying again")


def nobody(access: Access, user: str | None, password: bytes | None, shown: str) -> ClientIdentity | None:
    return RIGHT(access, user, password, shown) if user else ClientIdentity(role=Role.READER)


def without_password(_: Access, user: str | None, password: bytes | None, __: str) -> ClientIdentity | None:
    return ClientIdentity(role=Role.PLANT) if user and password is None else None


def with_any(_: Access, user: str | None, password: bytes | None, __: str) -> ClientIdentity | None:
    return ClientIdentity(role=Role.PLANT) if user and password else None


CARELESS = {
    "nobody in particular": nobody,
    "a user without password": without_password,
    "a wrong password": with_any,
}


def test_it_does_not_open_where_a_stranger_would_get_in(monkeypatch: pytest.MonkeyPatch) -> None:
    for who, careless in CARELESS.items():
        monkeypatch.setattr(Access, "login", careless)
        with pytest.raises(StartError, match=f"lets in {who}"):
            EmbeddedBroker(port=0, users=USERS).start()


def test_stopping_drops_everybody_and_leaves_the_port_for_the_next_start(
    broker: EmbeddedBroker,
    peer: Callable[..., Any],
    raw_peer: Callable[..., Any],
    capfd: pytest.CaptureFixture[str],
    caplog: pytest.LogCaptureFixture,
) -> None:
    address = broker.start()
    bridge = peer("bridge", address, subscriptions=["#"], announce=False).up()
    for n in range(20):
        raw_peer(address, f"board{n}", will=(f"board{n}/conexion", b"0"))
    idle, garbage = (socket.create_connection((address.host, address.port)) for _ in range(2))
    garbage.sendall(b"GET / HTTP/1.1\r\n\r\n")
    for n in range(90):
        bridge.client.publish(message("x", b"%d" % n))

    broker.stop()
    broker.stop()

    assert "mqtt broker" not in {thread.name for thread in threading.enumerate()}
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection((address.host, address.port))
    idle.close()
    garbage.close()
    again = EmbeddedBroker(port=address.port)
    try:
        assert again.start() == address
    finally:
        again.stop()
    assert capfd.readouterr().err == ""
    assert caplog.records == []


def test_many_boards_connect_at_once_and_lose_nothing(plant: Any, peer: Callable[..., Any]) -> None:
    """Brokers have lost messages while somebody subscribed."""
    boards = [
        peer(f"ra_1 {n}", plant.address, credentials=login("ra_1"), subscriptions=[f"ra_1/{n}"])
        for n in range(12)
    ]
    for n in range(100):
        plant.client.publish(message("ra_10/latido", b"%d" % n))
    for board in boards:
        board.up()
    plant.inbox.wait(lambda inbox: inbox.payloads == [b"%d" % n for n in range(100)])
