"""MQTT over TLS, with mosquitto: who believes whom, and what is said."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable
from typing import Any

import pytest

from arboleda.adapters.broker_login import CERTIFICATE, Address, address
from arboleda.wire.transport import Publication

from ..patience import PATIENCE_S
from ..tls_lab import Lab

pytestmark = pytest.mark.requires("mosquitto")


@pytest.fixture
def secure(mosquitto: Callable[..., Any], lab: Lab) -> Callable[..., int]:
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


def test_a_message_goes_over_tls_to_a_broker_that_asks_for_a_certificate(
    secure: Callable[..., int], trusts: Callable[..., None], lab: Lab, peer: Callable[..., Any]
) -> None:
    port = secure("127.0.0.1", f"cafile {lab.certificate}", "require_certificate true")
    trusts(lab.certificate, *lab.sign("plant"))
    broker = address(f"mqtts://127.0.0.1:{port}")
    board = peer("ra_1", broker, subscriptions=["ra_1/juntas"]).up()
    bridge = peer("bridge", broker).up()
    bridge.client.publish(Publication(topic="ra_1/juntas", payload=b"goal"))
    assert board.inbox.wait(lambda inbox: inbox.deliveries)[0].payload == b"goal"


@pytest.mark.parametrize(
    ("name", "days", "said"),
    [
        ("127.0.0.1", -1, "certificate has expired; renew it, or set the clock of this machine"),
        ("mill.lab", 1, "call the broker by a name that its certificate has"),
    ],
    ids=["expired", "wrong host"],
)
def test_a_broker_that_is_not_believed_is_told_why(
    secure: Callable[..., int],
    trusts: Callable[..., None],
    lab: Lab,
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
    name: str,
    days: int,
    said: str,
) -> None:
    trusts(lab.certificate)
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
    lab: Lab,
    peer: Callable[..., Any],
    caplog: pytest.LogCaptureFixture,
) -> None:
    port = secure("127.0.0.1", f"cafile {lab.certificate}", "require_certificate true")
    trusts(lab.certificate)
    peer("bridge", address(f"mqtts://127.0.0.1:{port}"))
    assert f"it may want a certificate of this client: ${CERTIFICATE}" in complaint(caplog)


@pytest.fixture(autouse=True)
def _warnings(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.WARNING, logger="arboleda.adapters.mqtt")
