"""The plant's own broker over TLS, with certificates by openssl: who is let in, and what each side says."""

from __future__ import annotations

import logging
import re
import socket
import ssl
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import CA, Address, Credentials, address
from arboleda.adapters.mqtt_broker import limits
from arboleda.adapters.server_tls import server_tls
from arboleda.model.errors import StartError
from arboleda.runtime.parts import broker as part
from arboleda.runtime.parts.broker import OwnBroker
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S
from .conftest import Authority, said

pytestmark = pytest.mark.requires("openssl")
USERS = {"ra_1": "secret", "ra_2": "hidden"}
Start = Callable[..., "tuple[EmbeddedBroker, Address]"]


@pytest.fixture
def own(lab: Authority) -> Iterator[Start]:
    """`own("127.0.0.1")`: a broker of the plant with a certificate for that name; it, and its address."""
    with ExitStack() as stack:

        def start(
            name: str = "127.0.0.1", *, days: int = 1, asks: bool = False
        ) -> tuple[EmbeddedBroker, Address]:
            tls = server_tls(*lab.sign(name, days=days), authority=lab.certificate if asks else None)
            broker = EmbeddedBroker(port=0, users=USERS, boards=frozenset(USERS), tls=tls)
            at = broker.start()
            stack.callback(broker.stop)
            return broker, at

        yield start


@pytest.fixture(autouse=True)
def _warnings(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="arboleda.adapters")


def board(name: str = "ra_1") -> Credentials:
    return Credentials(user=name, password=USERS[name])


def test_a_board_and_the_plant_speak_over_tls(
    own: Start, trusts: Callable[..., None], lab: Authority, peer: Callable[..., Any]
) -> None:
    trusts(lab.certificate)
    broker, at = own()
    there = address(f"mqtts://127.0.0.1:{at.port}")
    arm = peer("ra_1", there, credentials=board(), subscriptions=["ra_1/juntas"]).up()
    bridge = peer("bridge", at, credentials=broker.credentials, subscriptions=["ra_1/sensores"]).up()
    bridge.client.publish(Publication(topic="ra_1/juntas", payload=b"goal"))
    assert arm.inbox.wait(lambda inbox: inbox.payloads) == [b"goal"]
    arm.client.publish(Publication(topic="ra_1/sensores", payload=b"moving"))
    assert bridge.inbox.wait(lambda inbox: inbox.payloads) == [b"moving"]


@pytest.mark.parametrize(
    ("name", "days"), [("mill.lab", 1), ("127.0.0.1", -1)], ids=["other name", "expired"]
)
def test_the_plants_own_clients_believe_it_in_any_case(
    own: Start, peer: Callable[..., Any], name: str, days: int
) -> None:
    broker, at = own(name, days=days)
    peer("bridge", at, credentials=broker.credentials).up()


def test_the_plants_own_clients_believe_no_other_of_that_authority(
    own: Start, lab: Authority, peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    _, at = own()
    _, other = own()
    peer("bridge", Address(host=other.host, port=other.port, tls=at.tls), credentials=board())
    assert "its certificate is not believed" in said(caplog, "The MQTT broker at")


@pytest.mark.parametrize(
    ("name", "days", "believes", "client", "server"),
    [
        ("127.0.0.1", -1, True, "renew it, or set the clock of this machine", "it has expired"),
        ("mill.lab", 1, True, "call the broker by a name that its certificate has", "it may lack the name"),
        (
            "127.0.0.1",
            1,
            False,
            f"name the file of its authority in ${CA}",
            "give it the file of the authority",
        ),
    ],
    ids=["expired", "wrong host", "unknown authority"],
)
def test_a_certificate_that_is_not_believed_is_a_sentence_on_both_sides(
    own: Start,
    trusts: Callable[..., None],
    lab: Authority,
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
    name: str,
    days: int,
    believes: bool,
    client: str,
    server: str,
) -> None:
    trusts(lab.certificate if believes else None)
    _, at = own(name, days=days)
    peer("ra_1", address(f"mqtts://127.0.0.1:{at.port}"), credentials=board())
    assert client in said(caplog, f"The MQTT broker at mqtts://127.0.0.1:{at.port} is not there")
    assert server in said(caplog, "own broker: a client at 127.0.0.1 does not believe this certificate")


def pub(require: Callable[[str], str], port: int, *options: object) -> subprocess.CompletedProcess[str]:
    """mosquitto_pub as the board ra_1."""
    words = [
        require("mosquitto_pub"),
        "-h",
        "127.0.0.1",
        "-p",
        port,
        "-t",
        "ra_1/sensores",
        "-m",
        "1",
        "-q",
        "1",
    ]
    login = ["-u", "ra_1", "-P", USERS["ra_1"], "-i", "ra_1"]
    return subprocess.run(
        [*map(str, (*words, *login, *options))],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )


def test_mosquitto_pub_gets_through(
    own: Start, lab: Authority, require: Callable[[str], str], peer: Callable[..., Any]
) -> None:
    broker, at = own()
    plant = peer("bridge", at, credentials=broker.credentials, subscriptions=["ra_1/sensores"]).up()
    assert pub(require, at.port, "--cafile", lab.certificate).returncode == 0
    plant.inbox.wait(lambda inbox: inbox.payloads == [b"1"])


def test_mosquitto_pub_with_another_authority_is_told_of(
    own: Start, require: Callable[[str], str], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    _, at = own()
    assert pub(require, at.port, "--cafile", Authority(tmp_path / "other").certificate).returncode != 0
    said(caplog, "own broker: a client at 127.0.0.1 does not believe this certificate")


def test_mosquitto_pub_without_tls_is_told_of(
    own: Start, require: Callable[[str], str], caplog: pytest.LogCaptureFixture
) -> None:
    _, at = own()
    assert pub(require, at.port).returncode != 0
    said(caplog, "own broker: a client at 127.0.0.1 speaks no TLS to a port that speaks nothing else")


def test_a_plant_without_tls_is_told_that_the_broker_may_want_it(
    own: Start, peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    _, at = own()
    peer("ra_1", Address(host=at.host, port=at.port), credentials=board())
    assert "it may want TLS: mqtts://" in said(caplog, "The MQTT broker at")


def test_tls_to_a_broker_without_it_is_told_as_such(
    trusts: Callable[..., None], peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    plain = EmbeddedBroker(port=0)
    at = plain.start()
    try:
        peer("ra_1", address(f"mqtts://127.0.0.1:{at.port}"))
        assert "leave out mqtts://" in said(caplog, "The MQTT broker at")
    finally:
        plain.stop()


def test_where_it_asks_a_board_shows_a_certificate_with_its_name(
    own: Start, lab: Authority, require: Callable[[str], str]
) -> None:
    _, at = own(asks=True)
    shown = {name: ("--cert", files[0], "--key", files[1]) for name in USERS for files in [lab.sign(name)]}
    answers = [pub(require, at.port, "--cafile", lab.certificate, *each) for each in ((), *shown.values())]
    assert [answer.returncode == 0 for answer in answers] == [False, True, False]
    assert all("not authori" in answers[number].stderr.lower() for number in (0, 2))


def test_where_it_asks_the_plants_own_clients_need_none(own: Start, peer: Callable[..., Any]) -> None:
    broker, at = own(asks=True)
    peer("bridge", at, credentials=broker.credentials).up()


def test_a_certificate_of_another_authority_is_told_of(
    own: Start,
    lab: Authority,
    require: Callable[[str], str],
    tmp_path: Path,
    caplog: pytest.LogCaptureFixture,
) -> None:
    _, at = own(asks=True)
    certificate, key = Authority(tmp_path / "other").sign("ra_1")
    answer = pub(require, at.port, "--cafile", lab.certificate, "--cert", certificate, "--key", key)
    assert answer.returncode != 0
    said(caplog, "own broker: a client at 127.0.0.1 shows a certificate that is not believed: ")


def test_who_only_connects_makes_room_for_who_logs_in(
    own: Start, trusts: Callable[..., None], lab: Authority, peer: Callable[..., Any]
) -> None:
    trusts(lab.certificate)
    _, at = own()
    with ExitStack() as stack:
        silent = [
            stack.enter_context(socket.create_connection((at.host, at.port), PATIENCE_S))
            for _ in range(limits.WAITING + 8)
        ]
        peer("ra_1", address(f"mqtts://127.0.0.1:{at.port}"), credentials=board()).up()
        with pytest.raises((ConnectionResetError, AssertionError)):
            assert silent[0].recv(1)


def test_what_comes_in_pieces_and_much_at_once_arrives_whole(own: Start, peer: Callable[..., Any]) -> None:
    broker, at = own()
    reader = peer("reader", at, credentials=broker.credentials, subscriptions=["x"]).up()
    assert at.tls is not None and broker.credentials is not None
    inner = at.tls.wrap_bio(incoming := ssl.MemoryBIO(), outgoing := ssl.MemoryBIO())
    with socket.create_connection((at.host, at.port), PATIENCE_S) as talk:

        def send_slowly() -> None:
            data = outgoing.read()
            for start in range(0, len(data), 700):
                talk.sendall(data[start : start + 700])

        while True:
            try:
                inner.do_handshake()
                break
            except ssl.SSLWantReadError:
                send_slowly()
                incoming.write(talk.recv(4096))
        user, password = broker.credentials.user.encode(), broker.credentials.password.encode()
        fields = b"".join(len(each).to_bytes(2, "big") + each for each in (b"slow", user, password))
        body = b"\0\4MQTT\4\xc2\0\0" + fields
        inner.write(bytes((0x10, len(body))) + body)
        payloads = [bytes([65 + number]) * 100 for number in range(26)] * 20
        for payload in payloads:
            inner.write(b"\x30\x67\0\1x" + payload)
        send_slowly()
        reader.inbox.wait(lambda inbox: inbox.payloads == payloads)


@pytest.mark.parametrize("port", ["taken", "free"])
def test_it_listens_on_the_port_of_mqtt_over_tls(
    lab: Authority, free_port: int, monkeypatch: pytest.MonkeyPatch, port: str
) -> None:
    monkeypatch.setattr(part, "TLS_PORT", free_port)
    tls = server_tls(*lab.sign("127.0.0.1"))
    broker = OwnBroker("127.0.0.1", USERS, frozenset(USERS), found_by_port=True, tls=tls)
    if port == "taken":
        with socket.create_server(("127.0.0.1", free_port)), pytest.raises(StartError, match="is taken"):
            broker.start()
        return
    broker.start()
    try:
        assert str(broker.address) == f"mqtts://127.0.0.1:{free_port}"
    finally:
        broker.stop()


def test_a_file_that_is_of_no_use_is_named_before_anything_starts(lab: Authority, tmp_path: Path) -> None:
    certificate, key = lab.sign("127.0.0.1")
    other = lab.sign("ra_9")[1]
    encrypted = tmp_path / "locked.key"
    words = ["openssl", "ec", "-in", key, "-aes256", "-passout", "pass:x", "-out", encrypted]
    subprocess.run([str(word) for word in words], check=True, capture_output=True)
    for files in ((certificate, other), (certificate, None), (tmp_path / "none", key), (key, key)):
        with pytest.raises(StartError, match=re.escape(str(files[0]))):
            server_tls(*files)
    with pytest.raises(StartError, match="the key is encrypted; write it without password"):
        server_tls(certificate, encrypted)
    with pytest.raises(StartError, match=re.escape(str(key))):
        server_tls(certificate, key, authority=key)


def test_key_and_certificate_may_share_a_file_and_only_the_certificate_is_passed_on(
    lab: Authority, tmp_path: Path
) -> None:
    certificate, key = lab.sign("127.0.0.1")
    both = tmp_path / "both.pem"
    both.write_text(key.read_text() + certificate.read_text())
    assert server_tls(both).pem == certificate.read_text()[certificate.read_text().index("-----BEGIN CERT") :]


@pytest.mark.parametrize(("days", "words"), [(-1, "has expired on "), (3, "expires on "), (400, None)])
def test_the_start_says_of_a_certificate_that_it_ends(lab: Authority, days: int, words: str | None) -> None:
    note = server_tls(*lab.sign("127.0.0.1", days=days)).note(time.time())
    assert note is None if words is None else note is not None and words in note
