"""MQTT over TLS, with mosquitto and certificates that openssl made: who believes whom, and what is said."""

from __future__ import annotations

import logging
import re
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker_login import CA, CERTIFICATE, Address, address
from arboleda.model.errors import StartError
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S
from .conftest import Authority

pytestmark = [pytest.mark.requires("mosquitto"), pytest.mark.requires("openssl")]


@pytest.fixture
def secure(mosquitto: Callable[..., Any], lab: Authority) -> Callable[..., int]:
    """`secure("127.0.0.1")`: a mosquitto with a certificate for that name listens; its port."""

    def start(name: str, *options: str, days: int = 1) -> int:
        certificate, key = lab.sign(name, days=days)
        broker = mosquitto(
            "user root", "allow_anonymous true", f"certfile {certificate}", f"keyfile {key}", *options
        )
        broker.start()
        return int(broker.address.port)

    return start


def complaint(caplog: pytest.LogCaptureFixture) -> str:
    """The first line that the client logs."""
    end = time.monotonic() + PATIENCE_S
    while not caplog.messages:
        assert time.monotonic() < end, "nothing was said"
        time.sleep(0.01)
    return caplog.messages[0]


def test_a_message_goes_over_tls(
    secure: Callable[..., int], trusts: Callable[..., None], lab: Authority, peer: Callable[..., Any]
) -> None:
    trusts(lab.certificate)
    broker = address(f"mqtts://127.0.0.1:{secure('127.0.0.1')}")
    board = peer("ra_1", broker, subscriptions=["ra_1/juntas"]).up()
    bridge = peer("bridge", broker).up()
    bridge.client.publish(Publication(topic="ra_1/juntas", payload=b"goal"))
    assert board.inbox.wait(lambda inbox: inbox.deliveries)[0].payload == b"goal"


def test_a_broker_that_asks_gets_a_certificate(
    secure: Callable[..., int], trusts: Callable[..., None], lab: Authority, peer: Callable[..., Any]
) -> None:
    port = secure("127.0.0.1", f"cafile {lab.certificate}", "require_certificate true")
    trusts(lab.certificate, *lab.sign("plant"))
    peer("bridge", address(f"mqtts://127.0.0.1:{port}")).up()


@pytest.mark.parametrize(
    ("name", "days", "believes", "said"),
    [
        ("127.0.0.1", -1, True, "certificate has expired; renew it, or set the clock of this machine"),
        ("mill.lab", 1, True, "call the broker by a name that its certificate has"),
        ("127.0.0.1", 1, False, f"name the file of its authority in ${CA}"),
    ],
    ids=["expired", "wrong host", "unknown authority"],
)
def test_a_broker_that_is_not_believed_is_told_why(
    secure: Callable[..., int],
    trusts: Callable[..., None],
    lab: Authority,
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
    name: str,
    days: int,
    believes: bool,
    said: str,
) -> None:
    trusts(lab.certificate if believes else None)
    port = secure(name, days=days)
    stranger = peer("bridge", address(f"mqtts://127.0.0.1:{port}"))
    sentence = complaint(caplog)
    assert sentence.startswith(
        f"The MQTT broker at mqtts://127.0.0.1:{port} is not there (its certificate is"
    )
    assert said in sentence and stranger.inbox.links == []


def test_tls_to_a_port_without_it_is_told_as_such(
    mosquitto: Callable[..., Any],
    trusts: Callable[..., None],
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
) -> None:
    plain = mosquitto()
    plain.start()
    peer("bridge", address(f"mqtts://127.0.0.1:{plain.address.port}"))
    assert "leave out mqtts://" in complaint(caplog)


def test_no_tls_to_a_port_with_it_is_told_as_such(
    secure: Callable[..., int], peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    peer("bridge", Address(host="127.0.0.1", port=secure("127.0.0.1")))
    assert "it may want TLS: mqtts://" in complaint(caplog)


def test_a_client_without_the_certificate_that_is_asked_for_is_told_so(
    secure: Callable[..., int],
    trusts: Callable[..., None],
    lab: Authority,
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
) -> None:
    port = secure("127.0.0.1", f"cafile {lab.certificate}", "require_certificate true")
    trusts(lab.certificate)
    peer("bridge", address(f"mqtts://127.0.0.1:{port}"))
    assert f"it may want a certificate of this client: ${CERTIFICATE}" in complaint(caplog)


@pytest.mark.parametrize(
    ("file", "content"), [("authority", None), ("authority", "no certificate"), ("certificate", "nor this")]
)
def test_a_file_that_is_of_no_use_is_named_before_anything_starts(
    trusts: Callable[..., None], tmp_path: Path, file: str, content: str | None
) -> None:
    path = tmp_path / "file.pem"
    if content is not None:
        path.write_text(content)
    trusts(**{file: path})
    with pytest.raises(StartError, match=re.escape(str(path))):
        address("mqtts://broker.lab")


def test_a_key_without_its_certificate_is_refused(trusts: Callable[..., None], tmp_path: Path) -> None:
    trusts(key=tmp_path / "key.pem")
    with pytest.raises(StartError, match=re.escape(f"name that in ${CERTIFICATE}")):
        address("mqtts://broker.lab")


@pytest.mark.parametrize(
    ("text", "reads"),
    [
        ("mqtts://broker.lab", "mqtts://broker.lab:8883"),
        ("mqtts://[::1]:2883", "mqtts://[::1]:2883"),
        ("mqtt://broker.lab", "broker.lab:1883"),
        ("broker.lab:2883", "broker.lab:2883"),
    ],
)
def test_an_address_reads_as_it_is_written(trusts: Callable[..., None], text: str, reads: str) -> None:
    assert str(address(text)) == reads
    assert str(address(reads)) == reads


@pytest.fixture(autouse=True)
def _warnings(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="arboleda.adapters.mqtt")
