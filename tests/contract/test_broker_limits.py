"""What one client of the plant's own broker can take from the others: not much."""

from __future__ import annotations

import os
import select
import socket
import struct
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import Address, Credentials
from arboleda.adapters.mqtt_broker import limits
from arboleda.adapters.mqtt_broker.access import ALLOWED, Access, ClientIdentity, Role
from arboleda.model.errors import StartError
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S
from .conftest import text

USERS = {"ra_1": "one", "ra_2": "two", "ana": "look"}
BOARDS = frozenset({"ra_1", "ra_2"})
HUGE = b"\x80\x80\x80\x7f"  # a remaining length of 254 MB


@pytest.fixture
def guarded() -> Iterator[EmbeddedBroker]:
    made = EmbeddedBroker(port=0, users=USERS, boards=BOARDS)
    yield made
    made.stop()


@pytest.fixture
def guests() -> Iterator[EmbeddedBroker]:
    """A broker on which nobody needs a password."""
    made = EmbeddedBroker(port=0, boards=BOARDS)
    yield made
    made.stop()


@pytest.fixture
def few() -> Iterator[EmbeddedBroker]:
    """The same for ten connections: four may wait to log in, six are served."""
    made = EmbeddedBroker(port=0, boards=frozenset({"ra_1"}), connections=10)
    yield made
    made.stop()


@pytest.fixture
def crowd() -> Iterator[ExitStack]:
    with ExitStack() as opened:
        yield opened


def message(topic: str, payload: bytes = b"x", **options: Any) -> Publication:
    return Publication(topic=topic, payload=payload, **options)


def dial(address: Address, crowd: ExitStack) -> socket.socket:
    made = socket.create_connection((address.host, address.port), timeout=PATIENCE_S)
    return crowd.enter_context(made)


def is_cut(talk: socket.socket) -> bool:
    """Whether the broker ends this connection."""
    try:
        while talk.recv(65536):
            pass
    except ConnectionResetError:
        pass
    except TimeoutError:
        return False
    return True


def pour(talks: list[socket.socket], mb: int) -> None:
    """Send `mb` megabytes on each, as far as they are taken."""
    block = b"x" * 1_000_000
    for talk in talks:
        talk.settimeout(0.2)
        for _ in range(mb):
            try:
                talk.sendall(block)
            except OSError:
                break
        talk.settimeout(PATIENCE_S)


def resident_bytes() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def subscribe(*filters: str, number: int = 1) -> bytes:
    body = struct.pack("!H", number) + b"".join(text(each) + b"\x01" for each in filters)
    assert len(body) < 16384
    return bytes((0x82, len(body) & 127 | 128, len(body) >> 7)) + body


@pytest.mark.parametrize("logged_in", [False, True])
def test_huge_packets_take_no_memory(
    guarded: EmbeddedBroker, peer: Callable, raw_peer: Callable, crowd: ExitStack, logged_in: bool
) -> None:
    address = guarded.start()
    plant = peer("bridge", address, credentials=guarded.credentials, subscriptions=["#"]).up()
    before = resident_bytes()
    if logged_in:
        talks = [raw_peer(address, f"big {n}", login=("ana", "look")).socket for n in range(3)]
    else:
        talks = [dial(address, crowd) for _ in range(3)]
    for talk in talks:
        talk.sendall((b"\x30" if logged_in else b"\x10") + HUGE)
    pour(talks, 256)
    assert resident_bytes() - before < 50_000_000
    assert all(map(is_cut, talks))
    plant.client.publish(message("ra_1/paro"))
    assert plant.inbox.wait(lambda inbox: inbox.payloads) == [b"x"]
    assert plant.inbox.links == [True]


def test_of_those_that_have_not_logged_in_the_one_that_waits_longest_goes(
    guarded: EmbeddedBroker, raw_peer: Callable, crowd: ExitStack
) -> None:
    address = guarded.start()
    waiting = [dial(address, crowd) for _ in range(limits.WAITING + 3)]
    assert all(map(is_cut, waiting[:3]))
    assert raw_peer(address, "ra_1", login=("ra_1", "one")).answer == b"\0"
    assert select.select(waiting[5:], [], [], 0)[0] == []


def test_who_does_not_log_in_is_cut_off(
    monkeypatch: pytest.MonkeyPatch, guarded: EmbeddedBroker, crowd: ExitStack
) -> None:
    monkeypatch.setattr(limits, "HELLO_S", 0.2)
    assert is_cut(dial(guarded.start(), crowd))


def test_idle_clients_make_room_and_those_at_work_stay(
    few: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = few.start()
    board = peer("ra_1", address, subscriptions=["ra_1/juntas"]).up()
    idle = [raw_peer(address, f"idle {n}") for n in range(40)]
    assert {each.answer for each in idle} == {b"\0"}
    assert is_cut(idle[0].socket)
    plant = peer("bridge", address, credentials=few.credentials).up()
    plant.client.publish(message("ra_1/juntas"))
    board.inbox.wait(lambda inbox: inbox.payloads)
    assert board.inbox.links == [True]


def test_where_all_are_at_work_a_newcomer_is_told_so_and_the_plant_comes_in(
    few: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = few.start()
    boards = [peer(f"board {n}", address, subscriptions=["x"], announce=False).up() for n in range(6)]
    assert raw_peer(address, "late").answer == b"\x03"
    peer("bridge", address, credentials=few.credentials).up()
    boards[0].inbox.wait(lambda inbox: inbox.links[:2] == [True, False])
    assert all(board.inbox.links == [True] for board in boards[1:])


def test_a_user_has_a_number_of_connections(guarded: EmbeddedBroker, raw_peer: Callable) -> None:
    address = guarded.start()
    most = ALLOWED[Role.READER].connections
    looks = [raw_peer(address, f"{n}", login=("ana", "look")) for n in range(most)]
    for look in looks:
        look.socket.sendall(subscribe("#"))
        look.socket.recv(5)
    assert raw_peer(address, "one more", login=("ana", "look")).answer == b"\x03"
    assert raw_peer(address, "ra_1", login=("ra_1", "one")).answer == b"\0"


def test_a_client_id_belongs_to_its_user(guarded: EmbeddedBroker, peer: Callable, raw_peer: Callable) -> None:
    address = guarded.start()
    board = peer(
        "ra_2", address, credentials=Credentials(user="ra_2", password="two"), subscriptions=["ra_2/juntas"]
    ).up()
    plant = peer("bridge", address, credentials=guarded.credentials).up()
    for user in ("ana", "ra_1"):
        for client in ("ra_2", "bridge"):
            assert raw_peer(address, client, login=(user, USERS[user])).answer == b"\0"
    plant.client.publish(message("ra_2/juntas", b"goal"))
    assert board.inbox.wait(lambda inbox: inbox.payloads) == [b"goal"]
    assert board.inbox.links == plant.inbox.links == [True]


def test_a_later_connection_of_the_same_user_takes_the_place_of_the_earlier(
    guarded: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = guarded.start()
    plant = peer("bridge", address, credentials=guarded.credentials, subscriptions=["ra_1/conexion"]).up()
    first = raw_peer(address, "ra_1", login=("ra_1", "one"), will=("ra_1/conexion", b"0"))
    raw_peer(address, "ra_1", login=("ra_1", "one")).publish("ra_1/conexion", b"1")
    assert is_cut(first.socket)
    assert plant.inbox.wait(lambda inbox: len(inbox.payloads) == 2) and plant.inbox.payloads == [b"0", b"1"]


def test_retained_topics_are_few_enough_for_any_subscriber(
    guests: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = guests.start()
    before = resident_bytes()
    junk = raw_peer(address, "junk")
    for n in range(4000):
        junk.publish(f"junk/{n}", b"x" * 60, retain=True)
    junk.publish("ra_1/conexion", b"1", retain=True)
    presence = peer("bridge", address, subscriptions=["ra_1/conexion"]).up()
    presence.inbox.wait(lambda inbox: inbox.payloads)  # a guest may publish 2000 a second
    looker = peer("looker", address, subscriptions=["#"]).up()
    looker.inbox.wait(lambda inbox: b"1" in inbox.payloads)
    got = sum(len(delivery.topic) + len(delivery.payload) for delivery in looker.inbox.deliveries)
    assert got < limits.RETAINED_BYTES and looker.inbox.links == [True]
    assert resident_bytes() - before < 50_000_000


def test_subscriptions_are_limited_for_all_but_the_plant(
    guarded: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = guarded.start()
    reader = raw_peer(address, "ana", login=("ana", "look"))
    allowed = ALLOWED[Role.READER]
    filters = [f"+/{n}" for n in range(20)] + [f"t/{n}" for n in range(100)]
    reader.socket.sendall(subscribe(*filters))
    answer = reader.socket.recv(2 + 2 + len(filters), socket.MSG_WAITALL)[4:]
    assert answer.count(1) == allowed.filters
    assert answer[:20].count(1) == allowed.wildcards
    plant = peer(
        "bridge", address, credentials=guarded.credentials, subscriptions=[f"r{n}/x" for n in range(500)]
    )
    plant.up()


def test_a_client_that_reads_nothing_is_cut_off_and_the_others_hear_on(
    guests: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = guests.start()
    deaf = raw_peer(address, "deaf")
    deaf.socket.sendall(subscribe("#"))
    deaf.socket.recv(5, socket.MSG_WAITALL)
    hears = peer("hears", address, credentials=guests.credentials, subscriptions=["x"]).up()
    before = resident_bytes()
    loud = peer("loud", address, credentials=guests.credentials).up()
    for n in range(1, 2001):
        loud.client.publish(message("x", b"x" * 3000, qos=0))
        if n % 50 == 0:
            hears.inbox.wait(lambda inbox, n=n: len(inbox.payloads) == n)
    assert resident_bytes() - before < 50_000_000
    assert is_cut(deaf.socket)


def test_a_flood_of_packets_leaves_the_plant_its_turn(
    guarded: EmbeddedBroker, peer: Callable, raw_peer: Callable
) -> None:
    address = guarded.start()
    board = peer(
        "ra_1", address, credentials=Credentials(user="ra_1", password="one"), subscriptions=["ra_1/paro"]
    ).up()
    plant = peer("bridge", address, credentials=guarded.credentials, subscriptions=["ra_2/sensores"]).up()
    flood = [
        raw_peer(address, "2", login=("ra_2", "two")),
        *(raw_peer(address, f"{n}", login=("ana", "look")) for n in range(8)),
    ]
    talks = [each.socket for each in flood]
    for talk in talks:
        talk.setblocking(False)
    packets = [
        (b"\x30\x0f" + text("ra_2/sensores")) * 500,
        *[b"\xc0\x00" * 2000] * 4,
        *[subscribe("+/+/x") * 200] * 4,
    ]
    began, sent = time.monotonic(), 0
    while time.monotonic() - began < 1.5:
        for talk, packet in zip(talks, packets, strict=True):
            with suppress(OSError):
                talk.send(packet)
        plant.client.publish(message("ra_1/paro", b"%d" % sent))
        sent += 1
        board.inbox.wait(lambda inbox, sent=sent: len(inbox.payloads) == sent)
    assert plant.inbox.links == board.inbox.links == [True]
    # The bridge is not flooded by one board, which brings some thousand a second.
    assert len(plant.inbox.payloads) < 400 + 200 * (time.monotonic() - began), "200 at once and 200 a second"


def test_it_does_not_open_where_a_stranger_would_get_in(monkeypatch: pytest.MonkeyPatch) -> None:
    broker = EmbeddedBroker(port=0, users=USERS)
    right = Access.login

    def careless(
        access: Access, user: str | None, password: bytes | None, shown: str
    ) -> ClientIdentity | None:
        return right(access, user, password, shown) if user else ClientIdentity(role=Role.READER)

    monkeypatch.setattr(Access, "login", careless)
    with pytest.raises(StartError, match="lets in nobody in particular"):
        broker.start()


@pytest.mark.parametrize("careless", ["a user without password", "a wrong password"])
def test_it_does_not_open_where_a_wrong_password_would_do(
    monkeypatch: pytest.MonkeyPatch, careless: str
) -> None:
    def login(access: Access, user: str | None, password: bytes | None, _shown: str) -> ClientIdentity | None:
        there = user == "arboleda" and (password is None) is (careless == "a user without password")
        return ClientIdentity(role=Role.PLANT, user="arboleda") if there else None

    monkeypatch.setattr(Access, "login", login)
    with pytest.raises(StartError, match=f"lets in {careless}"):
        EmbeddedBroker(port=0, users=USERS).start()


def test_qos_2_comes_once(guests: EmbeddedBroker, peer: Callable, raw_peer: Callable) -> None:
    address = guests.start()
    hears = peer("hears", address, subscriptions=["x"]).up()
    raw = raw_peer(address, "raw").socket
    publish = b"\x34\x06" + text("x") + b"\0\x05" + b"!"
    raw.sendall(publish + publish.replace(b"\x34", b"\x3c", 1))
    assert raw.recv(8, socket.MSG_WAITALL) == b"\x50\x02\0\x05" * 2
    raw.sendall(b"\x62\x02\0\x05" + publish)
    assert raw.recv(8, socket.MSG_WAITALL) == b"\x70\x02\0\x05\x50\x02\0\x05"
    hears.inbox.wait(lambda inbox: inbox.payloads == [b"!", b"!"])
