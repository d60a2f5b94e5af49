"""The plant's own broker over TLS, for clients of others and of the plant.

What TLS does there is tried in memory, in tests/unit/adapters.
"""

from __future__ import annotations

import logging
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import CA, Address, Credentials, address
from arboleda.adapters.server_tls import server_tls

from ..patience import PATIENCE_S
from ..tls_lab import Lab
from .conftest import said

USERS = {"ra_1": "secret", "ra_2": "hidden"}
Start = Callable[..., "tuple[EmbeddedBroker, Address]"]


@pytest.fixture
def own(lab: Lab) -> Iterator[Start]:
    """`own()`: a broker of the plant that listens, and its address; `asks` for certificates of boards."""
    with ExitStack() as stack:

        def start(*, asks: bool = False) -> tuple[EmbeddedBroker, Address]:
            tls = server_tls(*lab.sign("127.0.0.1"), authority=lab.certificate if asks else None)
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


def pub(require: Callable[[str], str], port: int, *options: object) -> subprocess.CompletedProcess[str]:
    """mosquitto_pub as the board ra_1."""
    words = [require("mosquitto_pub"), "-h", "127.0.0.1", "-p", port]
    words += ["-t", "ra_1/sensores", "-m", "1", "-q", "1"]
    login = ["-u", "ra_1", "-P", USERS["ra_1"], "-i", "ra_1"]
    return subprocess.run(
        [*map(str, (*words, *login, *options))],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )


def test_mosquitto_pub_gets_through(
    own: Start, lab: Lab, require: Callable[[str], str], peer: Callable[..., Any]
) -> None:
    broker, at = own()
    plant = peer("bridge", at, credentials=broker.credentials, subscriptions=["ra_1/sensores"]).up()
    assert pub(require, at.port, "--cafile", lab.certificate).returncode == 0
    plant.inbox.wait(lambda inbox: inbox.payloads == [b"1"])


def test_who_does_not_believe_it_is_a_sentence_on_both_sides(
    own: Start, trusts: Callable[..., None], peer: Callable[..., Any], caplog: pytest.LogCaptureFixture
) -> None:
    trusts(None)
    _, at = own()
    peer("ra_1", address(f"mqtts://127.0.0.1:{at.port}"), credentials=board())
    there = f"The MQTT broker at mqtts://127.0.0.1:{at.port} is not there"
    assert f"name the file of its authority in ${CA}" in said(caplog, there)
    said(caplog, "own broker: a client at 127.0.0.1 does not believe this certificate")


def test_where_it_asks_a_board_shows_a_certificate_with_its_name_and_the_plant_none(
    own: Start, lab: Lab, require: Callable[[str], str], peer: Callable[..., Any]
) -> None:
    broker, at = own(asks=True)
    peer("bridge", at, credentials=broker.credentials).up()
    shown = {name: ("--cert", files[0], "--key", files[1]) for name in USERS for files in [lab.sign(name)]}
    answers = [pub(require, at.port, "--cafile", lab.certificate, *each) for each in ((), *shown.values())]
    assert [answer.returncode == 0 for answer in answers] == [False, True, False]
    assert all("not authori" in answers[number].stderr.lower() for number in (0, 2))
