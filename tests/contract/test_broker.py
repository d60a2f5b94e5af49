"""The embedded broker: who is let in, who may do what, and that nothing of it stays behind."""

from __future__ import annotations

import socket
import threading
import time

import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import Credentials
from arboleda.model.errors import StartError
from arboleda.model.plant_model import MqttVersion
from arboleda.wire.transport import Publication

from ..patience import SOON_S
from .conftest import said

USERS = {"ra_1": "one", "ra_10": "ten", "ana": "look"}
BOARDS = frozenset({"ra_1", "ra_10"})


@pytest.fixture
def broker():
    made = EmbeddedBroker(port=0)
    yield made
    made.stop()


@pytest.fixture
def guarded():
    made = EmbeddedBroker(port=0, users=USERS, boards=BOARDS)
    yield made
    made.stop()


def login(user: str, password: str | None = None) -> Credentials:
    return Credentials(user=user, password=password or USERS[user])


def message(topic: str, payload: bytes = b"x", **options) -> Publication:
    return Publication(topic=topic, payload=payload, **options)


@pytest.fixture
def plant(guarded, peer):
    """The plant's own client, which hears everything."""
    return peer("bridge", guarded.start(), credentials=guarded.credentials, subscriptions=["#"]).up()


def test_a_taken_port_is_one_sentence(broker):
    address = broker.start()
    with pytest.raises(StartError, match=f"cannot listen on 127.0.0.1:{address.port}: the port is taken"):
        EmbeddedBroker(port=address.port).start()


def test_a_foreign_host_is_one_sentence():
    with pytest.raises(StartError, match=r"cannot listen on 192\.0\.2\.1:0: "):
        EmbeddedBroker("192.0.2.1", 0, users=USERS).start()


@pytest.mark.parametrize("host", ["0.0.0.0", "192.0.2.1", "example.org", "::"])
def test_other_machines_are_let_in_only_with_users(host):
    with pytest.raises(StartError, match="give it a user and a password"):
        EmbeddedBroker(host, 0).start()


@pytest.mark.parametrize("users", [{"arboleda": "x"}, {"ra_1": ""}, {"": "x"}])
def test_useless_users_are_refused(users):
    with pytest.raises(StartError):
        EmbeddedBroker(port=0, users=users).start()


def test_with_users_it_can_be_opened_to_other_machines(peer):
    broker = EmbeddedBroker("0.0.0.0", 0, users=USERS)
    try:
        peer("bridge", broker.start(), credentials=broker.credentials).up()
    finally:
        broker.stop()


def test_the_plants_password_is_new_at_each_start_and_not_shown():
    first, second = (EmbeddedBroker(users=USERS).credentials for _ in range(2))
    assert first.password != second.password
    assert first.password not in repr(first)


@pytest.mark.parametrize(
    "credentials", [None, login("ra_1", "wrong"), login("nobody", "x"), login("arboleda", "guess")]
)
def test_a_stranger_is_refused(guarded, raw_peer, credentials):
    address = guarded.start()
    pair = (credentials.user, credentials.password) if credentials else None
    assert raw_peer(address, "ra_1", login=pair).answer == b"\x05"


def test_a_stranger_cannot_disturb_a_board_by_its_client_id(guarded, plant, peer, raw_peer):
    board = peer("ra_1", plant.address, credentials=login("ra_1"), subscriptions=["ra_1/juntas"]).up()
    raw_peer(plant.address, "ra_1", login=("ra_1", "wrong"), will=("ra_1/conexion", b"0")).close()

    plant.client.publish(message("ra_1/juntas", b"goal"))

    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"goal"]
    assert board.inbox.links == [True]
    assert b"0" not in plant.inbox.payloads


def test_a_board_writes_only_its_own_telemetry_and_presence(plant, peer):
    board = peer("ra_1", plant.address, credentials=login("ra_1")).up()
    refused = ["ra_1/juntas", "ra_1/paro", "ra_10/sensores", "ra_10/juntas", "rm_a/conexion", "other"]

    for topic in [*refused, "ra_1/conexion", "ra_1/sensores"]:
        board.client.publish(message(topic))

    plant.inbox.wait(lambda inbox: len(inbox.deliveries) == 2)
    assert [delivery.topic for delivery in plant.inbox.deliveries] == ["ra_1/conexion", "ra_1/sensores"]


@pytest.mark.parametrize("topic", ["#", "+/juntas", "ra_10/juntas"])
def test_a_board_reads_only_its_own_topics(plant, peer, caplog, topic):
    peer("ra_1", plant.address, credentials=login("ra_1"), subscriptions=["ra_1/juntas", topic])
    said(caplog, f"refused to subscribe ra_1 to {topic}; trying again")


def test_a_last_will_is_held_to_the_same_rules(plant, raw_peer):
    pair = ("ra_1", "one")
    assert raw_peer(plant.address, "a", login=pair, will=("ra_10/paro", b"1")).answer == b"\x05"
    assert raw_peer(plant.address, "b", login=pair, will=("ra_1/conexion", b"0")).answer == b"\x00"


def test_any_other_user_reads_everything_and_writes_nothing(plant, peer):
    ana = peer("screen", plant.address, credentials=login("ana"), subscriptions=["#"]).up()
    ana.client.publish(message("ra_1/juntas"))
    plant.client.publish(message("ra_1/latido", b"beat"))
    assert ana.inbox.wait(lambda inbox: inbox.payloads) == [b"beat"]
    assert plant.inbox.wait(lambda inbox: inbox.payloads) == [b"beat"]


def test_a_newcomer_gets_no_retained_message_that_it_did_not_ask_for(broker, peer):
    address = broker.start()
    peer("bridge", address, subscriptions=["ra_1/conexion"]).up().client.publish(
        message("ra_1/conexion", b"1", retain=True)
    )
    board = peer("ra_2", address, subscriptions=["ra_2/juntas"]).up()
    board.client.publish(message("ra_2/juntas", b"own"))
    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"own"]


def test_a_silent_board_is_dropped_after_one_and_a_half_keep_alives(broker, peer, raw_peer):
    address = broker.start()
    watcher = peer("bridge", address, subscriptions=["ra_1/conexion"]).up()
    began = time.monotonic()
    raw_peer(address, "ra_1", will=("ra_1/conexion", b"0"), keepalive=1)
    assert watcher.inbox.wait(lambda inbox: inbox.payloads) == [b"0"]
    assert time.monotonic() - began > 1.4


def test_mqtt_5_is_refused_in_one_sentence(broker, peer, caplog):
    peer("bridge", broker.start(), version=MqttVersion.V5)
    said(caplog, "over MQTT 5")
    time.sleep(1.0)  # several attempts more
    assert len(caplog.records) == 1
    assert "over MQTT 5: Unsupported protocol version" in caplog.text


def test_stopping_drops_everybody_at_once_and_leaves_nothing(broker, peer, raw_peer, capfd, caplog):
    address = broker.start()
    bridge = peer("bridge", address, subscriptions=["#"], announce=False).up()
    for n in range(20):
        raw_peer(address, f"board{n}", will=(f"board{n}/conexion", b"0"))
    idle = socket.create_connection((address.host, address.port))
    garbage = socket.create_connection((address.host, address.port))
    garbage.sendall(b"GET / HTTP/1.1\r\n\r\n")
    for n in range(90):
        bridge.client.publish(message("x", b"%d" % n))
    began = time.monotonic()

    broker.stop()
    broker.stop()

    assert time.monotonic() - began < SOON_S
    assert "mqtt broker" not in {thread.name for thread in threading.enumerate()}
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection((address.host, address.port))
    idle.close()
    garbage.close()
    assert capfd.readouterr().err == ""
    assert caplog.records == []


def test_it_can_be_stopped_before_it_was_started():
    EmbeddedBroker(port=0).stop()


def test_it_starts_again_on_the_port_it_left(broker, peer):
    address = broker.start()
    peer("bridge", address, announce=False).up()
    broker.stop()
    again = EmbeddedBroker(port=address.port)
    try:
        assert again.start() == address
    finally:
        again.stop()


def test_garbage_is_one_clients_end_only(broker, peer, capfd):
    address = broker.start()
    board = peer("ra_1", address, subscriptions=["ra_1/juntas"]).up()
    for junk in (
        b"\x10\xff\xff\xff\xff\x7f",
        b"\x10\x0c\x00\x04MQTT\x04\x02\x00",
        b"\x00\x00",
        b"\xff" * 64,
        b"\x30\x05\xff",
    ):
        with socket.create_connection((address.host, address.port)) as client:
            client.sendall(junk)
    board.client.publish(message("ra_1/juntas", b"fine"))
    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"fine"]
    assert board.inbox.links == [True]
    assert capfd.readouterr().err == ""


def test_many_boards_connect_at_once_and_lose_nothing(guarded, plant, peer):
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
