"""A mosquitto with the folder that `arboleda certs --mosquitto` makes: who is let in, and who may do what."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from arboleda.adapters.broker_login import address
from arboleda.cli.main import cli
from arboleda.wire.transport import Publication

from .conftest import Authority, said

pytestmark = [pytest.mark.requires("cryptography"), pytest.mark.requires("mosquitto")]
BY_THE_FIXTURE = ("#", "listener", "set_tcp_nodelay")


@pytest.fixture
def certs(tmp_path: Path) -> Callable[..., Result]:
    """`certs("--at", "/x")`: the command, with a mosquitto on this machine."""
    words = ["certs", str(tmp_path / "lab"), "--mosquitto", "127.0.0.1", "--mosquitto", "mill.lab"]
    return lambda *more: CliRunner().invoke(cli, [*words, *more])


@pytest.fixture
def lab_of(certs: Callable[..., Result], tmp_path: Path) -> Path:
    """The folder, and the broker that listens with it."""
    assert certs("--at", str(tmp_path / "lab/mosquitto")).exit_code == 0
    return tmp_path / "lab"


@pytest.fixture
def broker(mosquitto: Callable[..., Any], lab_of: Path) -> Any:
    lines = (lab_of / "mosquitto/mosquitto.conf").read_text().splitlines()
    started = mosquitto(
        "user root", *(line for line in lines if line and not line.startswith(BY_THE_FIXTURE))
    )
    started.start()
    return started


@pytest.fixture
def client(
    broker: Any, lab_of: Path, trusts: Callable[..., None], peer: Callable[..., Any]
) -> Callable[..., Any]:
    """A client with the certificate of that name, which hears some topics."""

    def connect(user: str, *topics: str, folder: Path = lab_of) -> Any:
        pair = folder / ("plant" if user == "plant" else f"boards/{user}")
        trusts(lab_of / "ca.crt", pair.with_suffix(".crt"), pair.with_suffix(".key"))
        return peer(user, address(f"mqtts://127.0.0.1:{broker.address.port}"), subscriptions=topics)

    return connect


def heard(listener: Any) -> list[str]:
    return [delivery.topic for delivery in listener.inbox.deliveries]


def test_plant_and_board_reach_each_other(client: Callable[..., Any]) -> None:
    plant, board = client("plant", "ra_1/sensores").up(), client("ra_1", "ra_1/juntas").up()
    plant.client.publish(Publication(topic="ra_1/juntas", payload=b"goal"))
    board.inbox.wait(lambda inbox: inbox.deliveries)
    board.client.publish(Publication(topic="ra_1/sensores", payload=b"moving"))
    plant.inbox.wait(lambda inbox: inbox.deliveries)


def test_a_board_can_neither_command_nor_speak_for_another(client: Callable[..., Any]) -> None:
    plant, other = client("plant", "#").up(), client("ra_2", "ra_1/sensores", "ra_2/juntas").up()
    for topic in ("ra_1/juntas", "ra_1/sensores", "ra_2/juntas", "ra_2/conexion"):
        other.client.publish(Publication(topic=topic, payload=b"1"))
    plant.inbox.wait(lambda inbox: inbox.deliveries)
    plant.client.publish(Publication(topic="ra_1/sensores", payload=b"secret"))
    plant.client.publish(Publication(topic="ra_2/juntas", payload=b"goal"))
    other.inbox.wait(lambda inbox: inbox.deliveries)
    assert heard(plant)[0] == "ra_2/conexion" and heard(other) == ["ra_2/juntas"]


@pytest.mark.requires("openssl")
def test_a_board_of_another_authority_is_not_let_in(
    client: Callable[..., Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    stranger = Authority(tmp_path / "boards")
    stranger.sign("ra_1")
    refused = client("ra_1", folder=tmp_path)
    said(caplog, "The MQTT broker at")
    assert refused.inbox.links == []


def test_a_second_time_all_of_it_stays_and_another_place_is_refused(
    certs: Callable[..., Result], lab_of: Path, tmp_path: Path
) -> None:
    before = {path: path.read_bytes() for path in lab_of.rglob("*") if path.is_file()}
    assert certs("--at", str(lab_of / "mosquitto")).exit_code == 0
    elsewhere = certs("--at", "/somewhere/else")
    assert "mosquitto.conf is there and says something else" in str(elsewhere.exception)
    assert {path: path.read_bytes() for path in lab_of.rglob("*") if path.is_file()} == before


def test_its_certificate_has_the_names_that_it_was_given_and_no_others(
    certs: Callable[..., Result], lab_of: Path
) -> None:
    line = next(
        line for line in certs("--at", str(lab_of / "mosquitto")).output.splitlines() if "broker.crt" in line
    )
    assert line.endswith("  mill.lab 127.0.0.1")
